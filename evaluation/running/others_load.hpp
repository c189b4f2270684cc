// What else the machine does while trials run.
#pragma once

#include <chrono>
#include <optional>

namespace glocal {

/// Measures from its construction on how many processors other processes keep busy (/proc/stat).
class OthersLoad {
 public:
  OthersLoad();
  /// In the mean so far; none within the first second, and where the system does not tell.
  [[nodiscard]] std::optional<double> mean() const;

 private:
  std::optional<double> busy_s_;  ///< All processors, at the beginning.
  double own_s_;                  ///< This process.
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace glocal
