// A search of the whole map, where draws do not settle the matter.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/prior.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/box_search/search_boxes.hpp"

namespace glocal::indexed_ransam {

/// When a search is due, and how far it goes.
struct ExactSearchRule {
  int after_steps = 5;
  /// The best pose is clear if no other pose has a score within this of its own. Not in YAML.
  double margin = 0.1;
  /// Contact that a pose needs to be searched for: less takes more time. Not in YAML.
  double min_contact = 0.75;
  std::optional<double> cell = {};
  int points = 512;
  int max_poses = 10;
  /// At a point; on maps of more than 2 hectares as many more as they are larger. A search ends then. Not in
  /// YAML.
  int max_looks = 40'000'000;
};
void describe(ParamVisitor& v, ExactSearchRule& p);

/// Searches all poses of the plane for those with much contact, by branch and bound on boxes of poses
/// (box_search/search_boxes.hpp), in rounds that ask for less and less.
class ExactSearch {
 public:
  /// Throws ConfigError where the map is too large for a pyramid.
  ExactSearch(const ExactSearchRule& rule, const GlobalMap& map, double contact_epsilon, int threads);

  /// Takes in the best poses of a step, and says whether a search is due now: after `after_steps` steps in a
  /// row in which no pose was clearly the best. The next search is due after twice as many such steps, and so
  /// on, until a pose is clearly the best or reset() is called. While one goes on, none is due.
  [[nodiscard]] bool is_due(const std::vector<Hypothesis>& best);
  void reset();

  [[nodiscard]] std::size_t points() const { return static_cast<std::size_t>(rule_.points); }

  /// Refines and judges the poses that a round has found. Returns the best poses so far, whoever found them.
  using Settle = std::function<std::vector<Hypothesis>(const std::vector<Pose2>& map_from_local)>;

  /// Begins a search for poses of these points of a local map.
  void begin(Points points, const Pose3& local_from_robot, const PoseGate& gate);

  /// Searches in rounds, each of which asks for less contact than the one before, and hands what it finds to
  /// `settle`. What is near the best pose so far is not searched for (Exclusion). The last round is the one
  /// after which a pose has a score that those of the next round would hardly reach, the one of
  /// `min_contact`, or the one that takes too many looks. Without a search that has begun, or once
  /// no looks are left (as BoxSearch::advance() takes them), nothing happens until the next call. Returns how
  /// many points were looked at.
  std::size_t advance(std::vector<Hypothesis> best, std::size_t looks_left, const Settle& settle);
  [[nodiscard]] bool goes_on() const { return open_.has_value(); }

 private:
  /// A search that has begun.
  struct Search {
    Points points;
    Pose3 local_from_robot;
    PoseGate gate;
    double bar;             ///< Share of contact that this round asks for.
    std::size_t looks = 0;  ///< Of the rounds before.
    std::optional<BoxSearch> round = {};
  };
  [[nodiscard]] BoxSearch round_of(const Search& search, const std::vector<Hypothesis>& best) const;

  ExactSearchRule rule_;
  std::shared_ptr<const BoxPyramid> pyramid_;  ///< Null where no search is ever due.
  std::size_t most_looks_;
  int threads_;
  std::optional<Search> open_ = {};
  int undecided_ = 0;  ///< Steps without a clear best pose.
  int wait_;           ///< For so many of them.
};

}  // namespace glocal::indexed_ransam
