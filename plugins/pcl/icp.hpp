// Iterative closest point from many starts.
#pragma once

#include <pcl/search/kdtree.h>

#include <memory>
#include <optional>
#include <vector>

#include "clouds.hpp"
#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::pcl_plugin {

/// One level of pcl::IterativeClosestPoint.
struct IcpParams {
  int points = 0;
  int iterations = 0;
  double max_distance = 0.0;
};
void describe(ParamVisitor& v, IcpParams& p);

/// Aligns points with a map by PCL's point-to-point ICP, in the plane.
class IcpAligner {
 public:
  using Tree = pcl::search::KdTree<pcl::PointXYZ>;

  explicit IcpAligner(const Points& map_points);

  /// From each start (map_from_points), the pose reached; the same for any number of threads.
  [[nodiscard]] std::vector<Pose2> align(const Points& points, const std::vector<Pose2>& starts,
                                         const IcpParams& params, int threads) const;

 private:
  Cloud::Ptr map_;
  Tree::Ptr tree_;
};

/// Those of the poses (map_from_local) that reach an Omega, by falling Omega; equal ones keep their order.
[[nodiscard]] std::vector<Hypothesis> rated(const std::vector<Pose2>& poses, const LocalMap& local,
                                            const ContactIndex& contact, double omega_max);

/// Multi-start ICP: starts with the robot on a grid of free places, in several headings; a few coarse
/// iterations with few points from all of them, then fine ones from those with the most contact.
class PclIcp final : public Matcher {
 public:
  struct Params {
    double start_spacing = 2.0;
    int start_headings = 8;
    IcpParams coarse{.points = 100, .iterations = 10, .max_distance = 2.0};
    int keep = 30;
    IcpParams fine{.points = 500, .iterations = 30, .max_distance = 0.5};
    std::optional<double> contact_epsilon = {};
  };

  /// Throws ConfigError if no start has free space in the map.
  PclIcp(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override {}

 private:
  Params params_;
  int threads_;
  std::vector<Pose2> map_from_robot_starts_;
  std::shared_ptr<const ContactIndex> contact_;
  IcpAligner aligner_;
};
void describe(ParamVisitor& v, PclIcp::Params& p);

}  // namespace glocal::pcl_plugin
