#include "app/drive_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "app/numbers.hpp"
#include "glocal/error.hpp"
#include "sources/bags/recording.hpp"
#include "sources/conversion/cloud_folder.hpp"
#include "sources/conversion/recording_drive.hpp"

namespace glocal::app {
namespace {

using conversion::DriveReader;

namespace fs = std::filesystem;

std::unique_ptr<DriveReader> open_recorded(const DriveOptions& options, const Warn& warn,
                                           const TellProgress& progress) {
  bags::DriveTopics topics;
  if (!options.scans.empty()) topics.scans = {options.scans};
  topics.odometry = options.odometry;
  topics.odom_frame = options.odom_frame;
  topics.base_frame = options.base_frame;
  topics.are_options = true;
  (is_topic(options.reference) ? topics.reference : topics.reference_frame) = options.reference;
  return std::make_unique<conversion::RecordingDriveReader>(options.file, topics,
                                                            bags::damage_if(options.strict), warn, progress);
}

std::unique_ptr<DriveReader> open_carmen(const DriveOptions& options) {
  options.refuse_choices("a CARMEN log says which scans, odometry and reference poses it has");
  return std::make_unique<conversion::CarmenDriveReader>(options.file, options.max_range);
}

clouds::DriveFiles cloud_files(const DriveOptions& options) {
  const fs::path folder = options.file;
  clouds::DriveFiles files{.folder = folder, .odometry = options.odometry, .reference = options.reference};
  if (files.odometry.empty()) files.odometry = odometry_of_clouds(folder);
  if (files.reference.empty() && fs::exists(folder / "reference.tum"))
    files.reference = folder / "reference.tum";
  return files;
}

std::unique_ptr<DriveReader> open_clouds(const DriveOptions& options, const Warn& warn,
                                         const TellProgress& progress) {
  refuse_topics_of_clouds(options.file, options.scans, options.odom_frame, options.base_frame);
  return std::make_unique<conversion::CloudFolderReader>(cloud_files(options), warn, progress);
}

}  // namespace

void add_strict(CLI::App& command, bool& strict) {
  command.add_flag("--strict", strict,
                   "Refuse a recording that is damaged behind something whole, instead of reading that");
}

void refuse_topics_of_clouds(const fs::path& folder, const std::string& scans, const std::string& odom_frame,
                             const std::string& base_frame) {
  for (const auto& [name, value] : {std::pair("--scans", scans), std::pair("--odom-frame", odom_frame),
                                    std::pair("--base-frame", base_frame)}) {
    if (!value.empty())
      throw ConfigError(folder, fmt::format("a folder of clouds has no topics: leave out {}", name));
  }
}

void DriveOptions::add_to(CLI::App& command, const std::string& name) {
  command
      .add_option(name, file,
                  "ROS 1 bag, ROS 2 bag (.db3 or its folder), MCAP, CARMEN log or folder of clouds")
      ->required();
  command.add_option("--scans", scans, "Topic with scans, where there are several");
  command.add_option("--odometry", odometry,
                     "Topic with odometry, or for clouds the file (default: tf, or the only one)");
  command.add_option("--odom-frame", odom_frame, "Frame of tf that odometry counts from (default: odom)");
  command.add_option("--base-frame", base_frame, "Frame of the robot (default: base_footprint or base_link)");
  command.add_option("--reference", reference,
                     "Reference poses: topic, or frame of tf, or for clouds the file");
  command
      .add_option("--max-range", max_range,
                  "CARMEN logs that do not say it: readings from here on met nothing, m")
      ->check(above_zero())
      ->capture_default_str();
  add_strict(command, strict);
}

bags::Recording DriveOptions::open_recording() const {
  return bags::Recording(file, bags::damage_if(strict));
}

void DriveOptions::refuse_choices(const std::string& why) const {
  for (const auto& [name, value] :
       {std::pair("--scans", scans), std::pair("--odometry", odometry), std::pair("--odom-frame", odom_frame),
        std::pair("--base-frame", base_frame), std::pair("--reference", reference)}) {
    if (!value.empty()) throw ConfigError(file, fmt::format("{}: leave out {}", why, name));
  }
}

std::unique_ptr<DriveReader> DriveOptions::open(const Warn& warn, const TellProgress& progress) const {
  switch (kind_of_log(file)) {
    case LogKind::recording:
      return open_recorded(*this, warn, progress);
    case LogKind::clouds:
      return open_clouds(*this, warn, progress);
    case LogKind::carmen:
      break;
  }
  return open_carmen(*this);
}

std::set<fs::path> DriveOptions::inputs() const {
  switch (kind_of_log(file)) {
    case LogKind::recording:
      return open_recording().inputs();
    case LogKind::clouds: {
      const clouds::DriveFiles files = cloud_files(*this);
      std::set<fs::path> inputs{files.folder, files.odometry, files.reference};
      inputs.erase(fs::path());
      return inputs;
    }
    case LogKind::carmen:
      break;
  }
  return {file};
}

}  // namespace glocal::app
