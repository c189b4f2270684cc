// A recorded drive on the command line, and what of it is to be read.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "app/log_kind.hpp"
#include "glocal/catalog.hpp"
#include "sources/bags/recording.hpp"
#include "sources/conversion/carmen_drive.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::app {

/// Adds --strict.
void add_strict(CLI::App& command, bool& strict);

/// Throws ConfigError for the first of these options that was given with a folder of clouds.
void refuse_topics_of_clouds(const std::filesystem::path& folder, const std::string& scans,
                             const std::string& odom_frame, const std::string& base_frame);

struct DriveOptions {
  std::string file;
  std::string scans, odometry, odom_frame, base_frame, reference;
  double max_range = conversion::sick_range;
  bool strict = false;

  /// Adds the file, as `name`, and all others. This object must live as long as the command.
  void add_to(CLI::App& command, const std::string& name);

  /// Opens the recording that the file is.
  [[nodiscard]] bags::Recording open_recording() const;

  /// Throws ConfigError for the first option that was given: `why` this input has no use for them.
  void refuse_choices(const std::string& why) const;

  /// Opens the drive, whatever it is. Throws ConfigError where kind_of_log() and the readers do, and for
  /// options that the input has no use for.
  [[nodiscard]] std::unique_ptr<conversion::DriveReader> open(const Warn& warn,
                                                              const TellProgress& progress) const;

  /// The files that are read, but for single clouds.
  [[nodiscard]] std::set<std::filesystem::path> inputs() const;
};

}  // namespace glocal::app
