#include "sources/bags/transform_tree.hpp"

#include <algorithm>

namespace glocal::bags {

void TransformTree::add(const FrameTransform& transform, bool is_static) {
  constexpr std::size_t most_frames = 10'000;
  const std::string& child = transform.child_frame;
  if (edges_.size() >= most_frames && !edges_.contains(child)) return;
  Edge& edge = edges_[child][transform.header.frame];
  if (is_static) {
    edge.fixed = transform.parent_from_child;
  } else {
    edge.track.add(transform.header.stamp_ns, transform.parent_from_child);
  }
}

void TransformTree::settle() {
  for (auto& [child, by_parent] : edges_) {
    const auto times_named = [](const auto& edge) {
      return edge.second.track.size() + (edge.second.fixed ? 1 : 0);
    };
    const auto parent =
        std::max_element(by_parent.begin(), by_parent.end(),
                         [&](const auto& a, const auto& b) { return times_named(a) < times_named(b); });
    parents_[child] = parent->first;
    parent->second.track.settle();
  }
}

std::vector<std::string> TransformTree::line_of(const std::string& frame) const {
  std::vector<std::string> line = {frame};
  // Frames of damaged recordings may be their own ancestors.
  while (line.size() <= parents_.size()) {
    const auto parent = parents_.find(line.back());
    if (parent == parents_.end()) break;
    line.push_back(parent->second);
  }
  return line;
}

std::optional<TransformTree::Way> TransformTree::way_between(const std::string& a,
                                                             const std::string& b) const {
  const std::vector<std::string> from_a = line_of(a), from_b = line_of(b);
  const auto meeting = std::find_first_of(from_a.begin(), from_a.end(), from_b.begin(), from_b.end());
  if (meeting == from_a.end()) return std::nullopt;
  return Way{{from_a.begin(), meeting}, {from_b.begin(), std::find(from_b.begin(), from_b.end(), *meeting)}};
}

bool TransformTree::connects(const std::string& a, const std::string& b) const {
  return way_between(a, b).has_value();
}

const TransformTree::Edge& TransformTree::edge_above(const std::string& frame) const {
  return edges_.at(frame).at(parents_.at(frame));
}

std::optional<Pose3> TransformTree::climbed(const std::vector<std::string>& frames, std::int64_t stamp_ns,
                                            std::int64_t max_gap_ns) const {
  Pose3 top_from_frame;
  for (const std::string& frame : frames) {
    const Edge& edge = edge_above(frame);
    const auto parent_from_frame = edge.fixed ? edge.fixed : edge.track.at(stamp_ns, max_gap_ns);
    if (!parent_from_frame) return std::nullopt;
    top_from_frame = *parent_from_frame * top_from_frame;
  }
  return top_from_frame;
}

std::optional<Pose3> TransformTree::pose(const std::string& in, const std::string& of, std::int64_t stamp_ns,
                                         std::int64_t max_gap_ns) const {
  const auto way = way_between(in, of);
  if (!way) return std::nullopt;
  const auto top_from_in = climbed(way->up_from_a, stamp_ns, max_gap_ns);
  const auto top_from_of = climbed(way->up_from_b, stamp_ns, max_gap_ns);
  if (!top_from_in || !top_from_of) return std::nullopt;
  return inverse(*top_from_in) * *top_from_of;
}

bool TransformTree::is_still(const std::string& in, const std::string& of) const {
  const auto way = way_between(in, of);
  const auto stands = [&](const std::string& frame) {
    const Edge& edge = edge_above(frame);
    return edge.fixed || edge.track.is_still();
  };
  return way && std::all_of(way->up_from_a.begin(), way->up_from_a.end(), stands) &&
         std::all_of(way->up_from_b.begin(), way->up_from_b.end(), stands);
}

}  // namespace glocal::bags
