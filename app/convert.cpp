// glocal convert: drives from one format to another one.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "app/cloud_folder_writer.hpp"
#include "app/commands.hpp"
#include "app/interrupts.hpp"
#include "app/log_kind.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"
#include "sources/conversion/carmen_drive.hpp"
#include "sources/conversion/cloud_folder.hpp"
#include "sources/conversion/copied_recording.hpp"
#include "sources/conversion/recording_drive.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string in, out;
  std::string scans, odometry, odom_frame, base_frame, reference;
  double max_range = sick_range;
  bool force = false;
};

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw ConfigError({{file, 0, 0, what}});
}

void warn(const std::string& text) {
  spdlog::warn("{}", text);
}

/// A file that is written in large pieces, under a temporary name until it is whole.
class GrowingFile {
 public:
  GrowingFile(fs::path file, bool replace) : file_(std::move(file)), files_(replace) {
    files_.add(file_, "");
  }

  void append(std::string_view bytes) {
    constexpr std::size_t enough = 1U << 20U;
    if (is_interrupted()) throw RunError("interrupted; nothing is left of " + file_.string());
    buffer_ += bytes;
    if (buffer_.size() >= enough) flush();
  }
  void commit() {
    flush();
    files_.commit();
  }
  [[nodiscard]] std::function<void(std::string_view)> sink() {
    return [this](std::string_view bytes) { append(bytes); };
  }

 private:
  void flush() {
    files_.append(buffer_);
    buffer_.clear();
  }

  fs::path file_;
  AtomicFiles files_;
  std::string buffer_;
};

std::unique_ptr<DriveReader> open_recording(const ConvertOptions& options) {
  bags::DriveTopics topics;
  if (!options.scans.empty()) topics.scans = {options.scans};
  topics.odometry = options.odometry;
  topics.odom_frame = options.odom_frame;
  topics.base_frame = options.base_frame;
  (is_topic(options.reference) ? topics.reference : topics.reference_frame) = options.reference;
  return std::make_unique<RecordingDriveReader>(options.in, topics, warn);
}

/// What only some inputs have is not to be passed over in silence.
void refuse_choices(const ConvertOptions& options, const std::string& why) {
  for (const auto& [name, value] :
       {std::pair("--scans", options.scans), std::pair("--odometry", options.odometry),
        std::pair("--odom-frame", options.odom_frame), std::pair("--base-frame", options.base_frame),
        std::pair("--reference", options.reference)}) {
    if (!value.empty()) refuse(options.in, fmt::format("{}: leave out {}", why, name));
  }
}

void tell(const DriveCounts& counts, const ConvertOptions& options) {
  fmt::print("{} scans, {} of them with reference pose, in {}\n", counts.scans, counts.references,
             options.out);
}

void copy_to_mcap(const ConvertOptions& options) {
  refuse_choices(options, "all topics of a recording are copied to MCAP");
  bags::Recording recording(options.in);
  GrowingFile file(options.out, options.force);
  const CopiedRecording copied = copy_recording(recording, file.sink());
  for (const std::string& text : recording.warnings()) warn(text);
  for (const std::string& remark : copied.remarks) warn(fmt::format("{}: {}", options.in, remark));
  file.commit();
  fmt::print("{} messages in {}\n", copied.messages, options.out);
}

std::unique_ptr<DriveReader> open_carmen(const ConvertOptions& options) {
  refuse_choices(options, "a CARMEN log says which scans, odometry and reference poses it has");
  return std::make_unique<CarmenDriveReader>(options.in, options.max_range);
}

std::unique_ptr<DriveReader> open_clouds(const ConvertOptions& options) {
  for (const auto& [name, value] :
       {std::pair("--scans", options.scans), std::pair("--odom-frame", options.odom_frame),
        std::pair("--base-frame", options.base_frame)}) {
    if (!value.empty())
      refuse(options.in, fmt::format("a folder of clouds has no topics: leave out {}", name));
  }
  const fs::path folder = options.in;
  DriveFiles files{.folder = folder, .odometry = options.odometry, .reference = options.reference};
  if (files.odometry.empty()) files.odometry = odometry_of_clouds(folder);
  if (files.reference.empty() && fs::exists(folder / "reference.tum"))
    files.reference = folder / "reference.tum";
  return std::make_unique<CloudFolderReader>(files, warn);
}

void write_mcap(DriveReader& reader, const ConvertOptions& options) {
  GrowingFile file(options.out, options.force);
  McapDriveWriter writer(reader.sensors(), file.sink());
  const DriveCounts counts = pass_on(reader, writer, options.in, warn);
  file.commit();
  tell(counts, options);
}

void to_mcap(const ConvertOptions& options) {
  const LogKind kind = kind_of_log(options.in);
  if (kind == LogKind::recording) return copy_to_mcap(options);
  write_mcap(kind == LogKind::carmen ? *open_carmen(options) : *open_clouds(options), options);
}

void to_carmen(const ConvertOptions& options) {
  const LogKind kind = kind_of_log(options.in);
  if (kind == LogKind::carmen) refuse(options.in, "is a CARMEN log already; name OUT *.mcap");
  if (kind == LogKind::clouds)
    refuse(options.in,
           "has clouds, which cannot be written as a CARMEN log: it has planar scans only; name OUT *.mcap");
  const auto reader = open_recording(options);
  GrowingFile file(options.out, options.force);
  CarmenDriveWriter writer(options.in, file.sink());
  const DriveCounts counts = pass_on(*reader, writer, options.in, warn);
  file.commit();
  tell(counts, options);
}

/// Experiments take the sensor to be where the robot is unless they say something else.
void tell_mount(const Pose3& robot_from_sensor) {
  if (robot_from_sensor == Pose3{}) return;
  const std::array<double, 9> m = matrix_of(robot_from_sensor.rotation);
  fmt::print(
      "the sensor's place: --set 'observations.cloud_drive.sensor={{x: {:.6g}, y: {:.6g}, z: {:.6g}, "
      "roll_deg: {:.6g}, pitch_deg: {:.6g}, yaw_deg: {:.6g}}}'\n",
      robot_from_sensor.x, robot_from_sensor.y, robot_from_sensor.z, degrees(std::atan2(m[7], m[8])),
      degrees(std::asin(std::clamp(-m[6], -1.0, 1.0))), degrees(std::atan2(m[3], m[0])));
}

void to_folder(const ConvertOptions& options, const Context& context) {
  const LogKind kind = kind_of_log(options.in);
  if (kind == LogKind::clouds) refuse(options.in, "is a folder of clouds already; name OUT *.mcap");
  if (kind == LogKind::carmen)
    refuse(options.in, "has planar scans, which are no clouds in space; name OUT *.mcap");
  const auto reader = open_recording(options);
  OutputFolder folder(options.out, options.force);
  CloudFolderWriter writer(folder, options.in);
  const DriveCounts counts = pass_on(*reader, writer, options.in, warn);
  FileHashes hashes;
  const bags::Recording recording(options.in);
  const std::set<fs::path> inputs(recording.files().begin(), recording.files().end());
  folder.append("provenance.json", provenance(context.catalog, 1, inputs, hashes).dump(2) + "\n");
  folder.commit();
  tell(counts, options);
  tell_mount(writer.robot_from_sensor());
}

void convert(const ConvertOptions& options, const Context& context) {
  listen_to_interrupts();
  const fs::path out = options.out;
  if (out.extension() == ".mcap") return to_mcap(options);
  if (out.extension() == ".log") return to_carmen(options);
  if (!out.has_filename() || fs::is_directory(out)) return to_folder(options, context);
  refuse(options.out, "the name says no format; name a file *.mcap or *.log (CARMEN), or a folder NAME/");
}

}  // namespace

void add_convert(CLI::App& app, Context& context) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "Write a recorded drive in another format: MCAP, CARMEN or clouds.");
  command
      ->add_option("IN", options->in,
                   "ROS 1 bag, ROS 2 bag (.db3 or its folder), MCAP, CARMEN log or folder of clouds")
      ->required();
  command->add_option("OUT", options->out, "*.mcap, *.log (CARMEN), or a folder for clouds (NAME/)")
      ->required();
  command->add_option("--scans", options->scans, "Topic with scans, where there are several");
  command->add_option("--odometry", options->odometry,
                      "Topic with odometry, or for clouds the file (default: tf, or the only one)");
  command->add_option("--odom-frame", options->odom_frame,
                      "Frame of tf that odometry counts from (default: odom)");
  command->add_option("--base-frame", options->base_frame,
                      "Frame of the robot (default: base_footprint or base_link)");
  command->add_option("--reference", options->reference,
                      "Reference poses: topic, or frame of tf, or for clouds the file");
  command
      ->add_option("--max-range", options->max_range,
                   "CARMEN logs that do not say it: readings from here on met nothing, m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--force", options->force, "Replace what is there");
  command->callback([options, &context] { convert(*options, context); });
}

}  // namespace glocal::app
