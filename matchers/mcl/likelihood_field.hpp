// How likely the ends of beams are, looked up in the map (end point model).
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "glocal/distance_field.hpp"
#include "glocal/global_map.hpp"
#include "glocal/points.hpp"

namespace glocal::mcl {

/// Parameters of the model, with the names and defaults of AMCL (Nav2).
struct LikelihoodFieldRule {
  double z_hit = 0.5;
  double z_rand = 0.5;
  double sigma_hit = 0.2;       ///< Standard deviation of a hit, m.
  double max_range = 100.0;     ///< m
  double max_distance = 2.0;    ///< At which the likelihood stops falling, m; laser_likelihood_max_dist.
  double distance_cell = 0.05;  ///< m
};

/// p(z | x, m) of a beam whose end lies so far (m) from the nearest point of the map, as AMCL computes it
/// (after Thrun, Burgard and Fox, Probabilistic Robotics, Table 6.3; the normal distribution has height 1
/// there).
[[nodiscard]] double likelihood_of_distance(double distance, const LikelihoodFieldRule& rule);

/// A table of square cells, row by row; what lies outside counts as the nearest cell at its border.
struct FieldCells {
  float min_x, min_y;  ///< m
  float scale;         ///< Cells per metre.
  int columns, rows;
  const float* cells;
};

/// A table of what a beam's end adds to a pose's score, cell by cell.
class LikelihoodField {
 public:
  /// For each end of a beam, `term` of its likelihood is added. Throws ConfigError if it would need more than
  /// 1 GiB.
  LikelihoodField(const GlobalMap& map, const LikelihoodFieldRule& rule,
                  const std::function<double(double likelihood)>& term);

  using Sums = std::array<float, MotionBatch::capacity>;
  /// For each of the first `size` poses, the sum over all ends of beams (m, in the robot's frame). Timed by
  /// bench_mcl.
  void sum(const Points& ends, const MotionBatch& map_from_robot, std::size_t size, Sums& sums) const;

  /// The term at one place.
  [[nodiscard]] float at(float x, float y) const;

 private:
  float min_x_ = 0.0F, min_y_ = 0.0F;  ///< Outer corner of cell (0, 0).
  float scale_ = 0.0F;                 ///< Cells per metre.
  int columns_ = 0, rows_ = 0;
  std::vector<float> cells_;  ///< The outermost ones are farther than max_distance from all points.
};

}  // namespace glocal::mcl
