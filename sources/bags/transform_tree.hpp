// Where frames are in each other over time, as tf has it: each frame has one parent.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "glocal/pose3.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/pose_track.hpp"

namespace glocal::bags {

class TransformTree {
 public:
  /// A static one holds at all times; a later one takes its place. More than 10,000 frames are not noted.
  void add(const FrameTransform& transform, bool is_static);
  /// To be called once all transforms are there. A frame that was said to have several parents has that which
  /// was named most often.
  void settle();

  /// Whether there is a way through the tree from one frame to the other; each frame has one to itself.
  [[nodiscard]] bool connects(const std::string& a, const std::string& b) const;
  /// The pose of a frame in another one. None if no way connects them, or a transform on the way is not known
  /// at this time (PoseTrack::at).
  [[nodiscard]] std::optional<Pose3> pose(const std::string& in, const std::string& of, std::int64_t stamp_ns,
                                          std::int64_t max_gap_ns) const;
  /// Whether the pose of a frame in another one never changes.
  [[nodiscard]] bool is_still(const std::string& in, const std::string& of) const;
  [[nodiscard]] const std::map<std::string, std::string>& parents() const { return parents_; }

 private:
  struct Edge {
    PoseTrack track;
    std::optional<Pose3> fixed;
  };
  /// The frame, its parent, and so on up to the root.
  [[nodiscard]] std::vector<std::string> line_of(const std::string& frame) const;
  /// Those up to, and without, where the lines of both frames meet.
  struct Way {
    std::vector<std::string> up_from_a, up_from_b;
  };
  [[nodiscard]] std::optional<Way> way_between(const std::string& a, const std::string& b) const;
  [[nodiscard]] const Edge& edge_above(const std::string& frame) const;
  [[nodiscard]] std::optional<Pose3> climbed(const std::vector<std::string>& frames, std::int64_t stamp_ns,
                                             std::int64_t max_gap_ns) const;

  std::map<std::string, std::map<std::string, Edge>> edges_;  ///< By child and parent.
  std::map<std::string, std::string> parents_;
};

}  // namespace glocal::bags
