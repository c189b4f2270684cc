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

/// What tf says of a frame in its parent.
struct TransformEdge {
  PoseTrack track;
  std::optional<Pose3> fixed;
  bool may_grow = false;

  /// The pose that it always has, or has had so far; none if it moves.
  [[nodiscard]] std::optional<Pose3> still() const;
  /// The pose at a time (PoseTrack::at). One that is still, and can no longer change, has its pose at all
  /// times, or if it `may_move` as long as it is told, give or take `max_gap_ns`.
  [[nodiscard]] std::optional<Pose3> at(std::int64_t stamp_ns, std::int64_t max_gap_ns, bool may_move) const;
};

/// The way through a tree from one frame to another one. Valid as long as its tree is, or what that was moved
/// to.
class FramePath {
 public:
  /// The pose of the second frame in the first one. None if a transform on the way is not known at this time
  /// (TransformEdge::at).
  [[nodiscard]] std::optional<Pose3> pose(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;
  /// Whether that pose never changes.
  [[nodiscard]] bool is_still() const;

 private:
  friend class TransformTree;
  /// From a frame up to where both ways meet.
  struct Climb {
    Pose3 still;                                    ///< Of the first edges together, all of which are.
    std::vector<const TransformEdge*> moving = {};  ///< Those from the first on that is not.
    bool may_move = false;

    void add(const TransformEdge& edge);
    [[nodiscard]] std::optional<Pose3> top_from_frame(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;
  };
  Climb from_first_, from_second_;
};

class TransformTree {
 public:
  /// A static one holds at all times; a later one takes its place. More than 10,000 frames are not noted.
  void add(const FrameTransform& transform, bool is_static);
  /// To be called once all transforms are there, or whenever the tree is asked where more may come. A frame
  /// that was said to have several parents has that which was named most often.
  void settle(bool more_may_come = false);
  /// Forgets how frames moved before a time (PoseTrack::forget_before).
  void forget_before(std::int64_t stamp_ns);

  /// The pose of one frame in the other over time; each frame has a way to itself. None if no way connects
  /// them. What has been still so far is taken to stay so, as sensors on a robot do, unless it `may_move`, as
  /// the robot does.
  [[nodiscard]] std::optional<FramePath> path(const std::string& in, const std::string& of,
                                              bool may_move = false) const;
  [[nodiscard]] const std::map<std::string, std::string>& parents() const { return parents_; }

 private:
  /// The frame, its parent, and so on up to the root.
  [[nodiscard]] std::vector<std::string> line_of(const std::string& frame) const;
  [[nodiscard]] FramePath::Climb climb(const std::vector<std::string>& line, const std::string& top,
                                       bool may_move) const;

  std::map<std::string, std::map<std::string, TransformEdge>> edges_;  ///< By child and parent.
  std::map<std::string, std::string> parents_;
};

}  // namespace glocal::bags
