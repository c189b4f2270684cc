#include "sources/bags/transform_tree.hpp"

#include <algorithm>
#include <set>

namespace glocal::bags {

void TransformTree::add(const FrameTransform& transform, bool is_static) {
  constexpr std::size_t most_frames = 10'000;
  const std::string& child = transform.child_frame;
  if (edges_.size() >= most_frames && !edges_.contains(child)) return;
  TransformEdge& edge = edges_[child][transform.header.frame];
  if (is_static) {
    edge.fixed = transform.parent_from_child;
  } else {
    edge.track.add(transform.header.stamp_ns, transform.parent_from_child);
  }
}

void TransformTree::settle(bool more_may_come) {
  for (auto& [child, by_parent] : edges_) {
    const auto times_named = [](const auto& edge) {
      return edge.second.track.size() + (edge.second.fixed ? 1 : 0);
    };
    const auto parent = std::ranges::max_element(by_parent, {}, times_named);
    parents_[child] = parent->first;
    parent->second.track.settle();
    parent->second.may_grow = more_may_come;
  }
}

void TransformTree::forget_before(std::int64_t stamp_ns) {
  for (auto& [child, by_parent] : edges_) {
    for (auto& [parent, edge] : by_parent) {
      edge.track.settle();
      edge.may_grow = true;
      edge.track.forget_before(stamp_ns);
    }
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

std::optional<FramePath> TransformTree::path(const std::string& in, const std::string& of,
                                             bool may_move) const {
  const std::vector<std::string> from_in = line_of(in), from_of = line_of(of);
  const std::set<std::string> above_of(from_of.begin(), from_of.end());
  const auto top =
      std::ranges::find_if(from_in, [&](const std::string& frame) { return above_of.contains(frame); });
  if (top == from_in.end()) return std::nullopt;
  FramePath path;
  path.from_first_ = climb(from_in, *top, may_move);
  path.from_second_ = climb(from_of, *top, may_move);
  return path;
}

FramePath::Climb TransformTree::climb(const std::vector<std::string>& line, const std::string& top,
                                      bool may_move) const {
  FramePath::Climb climb;
  climb.may_move = may_move;
  for (auto frame = line.begin(); *frame != top; ++frame)
    climb.add(edges_.at(*frame).at(parents_.at(*frame)));
  return climb;
}

std::optional<Pose3> TransformEdge::still() const {
  if (fixed) return fixed;
  return track.is_still() ? std::optional(track.first()) : std::nullopt;
}

std::optional<Pose3> TransformEdge::at(std::int64_t stamp_ns, std::int64_t max_gap_ns, bool may_move) const {
  if (fixed) return fixed;
  if (may_grow || !track.is_still()) return track.at(stamp_ns, max_gap_ns);
  const auto [first_ns, last_ns] = track.span();
  const bool is_told = stamp_ns >= first_ns - max_gap_ns && stamp_ns <= last_ns + max_gap_ns;
  return may_move && !is_told ? std::nullopt : std::optional(track.first());
}

void FramePath::Climb::add(const TransformEdge& edge) {
  const auto parent_from_frame = may_move ? edge.fixed : edge.still();
  if (moving.empty() && parent_from_frame) {
    still = *parent_from_frame * still;
  } else {
    moving.push_back(&edge);
  }
}

std::optional<Pose3> FramePath::Climb::top_from_frame(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  Pose3 top_from_frame = still;
  for (const TransformEdge* edge : moving) {
    const auto parent_from_frame = edge->at(stamp_ns, max_gap_ns, may_move);
    if (!parent_from_frame) return std::nullopt;
    top_from_frame = *parent_from_frame * top_from_frame;
  }
  return top_from_frame;
}

std::optional<Pose3> FramePath::pose(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  const auto top_from_first = from_first_.top_from_frame(stamp_ns, max_gap_ns);
  const auto top_from_second = from_second_.top_from_frame(stamp_ns, max_gap_ns);
  if (!top_from_first || !top_from_second) return std::nullopt;
  return inverse(*top_from_first) * *top_from_second;
}

bool FramePath::is_still() const {
  const auto stands = [](const TransformEdge* edge) { return edge->still().has_value(); };
  return std::ranges::all_of(from_first_.moving, stands) && std::ranges::all_of(from_second_.moving, stands);
}

}  // namespace glocal::bags
