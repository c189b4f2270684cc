// Drives recorded with CARMEN.
#pragma once

#include <cstddef>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/carmen/log_drive.hpp"

namespace glocal::carmen {

class CarmenLog final : public ObservationSource {
 public:
  using Params = LogParams;

  /// Reads the log; see read_log_drive() for what it throws.
  CarmenLog(const Params& params, const SourceSetup& setup);

  [[nodiscard]] std::optional<Sample> next() override;

 private:
  Params params_;
  LogDrive drive_;
  std::size_t next_ = 0;
};

}  // namespace glocal::carmen
