// Whether confidences mean what they say.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {

/// Confidences and outcomes in bins (reliability diagram; Murphy and Winkler 1977). Bins are narrow where
/// declarations are made.
class Reliability {
 public:
  struct Bin {
    double low = 0.0;
    double high = 0.0;
    double mean_confidence = 0.0;
    std::size_t count = 0;
    Proportion right;  ///< With its 95 % interval.

    /// The mean confidence is not within the interval of what was right.
    [[nodiscard]] bool is_off() const { return mean_confidence < right.low || mean_confidence > right.high; }
  };

  /// `confidence` in [0, 1].
  void add(double confidence, bool is_right);

  /// Those with anything in them, by rising confidence.
  [[nodiscard]] std::vector<Bin> bins() const;

 private:
  static constexpr std::array<double, 9> edges = {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 1.0};
  struct Sums {
    std::size_t count = 0;
    std::size_t right = 0;
    double confidence = 0.0;
  };
  std::array<Sums, edges.size() - 1> sums_{};
};

}  // namespace glocal
