// glocal convert: drives from one format to another one.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "app/cloud_folder_writer.hpp"
#include "app/commands.hpp"
#include "app/drive_options.hpp"
#include "app/interrupts.hpp"
#include "app/reading_bar.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"
#include "sources/conversion/carmen_drive.hpp"
#include "sources/conversion/copied_recording.hpp"
#include "sources/conversion/recording_drive.hpp"

namespace glocal::app {
namespace {

using conversion::DriveCounts;

namespace fs = std::filesystem;

struct ConvertOptions {
  DriveOptions in;
  std::string out;
  bool force = false;
};

/// Takes a file's bytes piece by piece.
auto sink_of(AtomicFiles& files, const std::string& out) {
  return [&](std::string_view bytes) {
    if (is_interrupted()) throw RunError("interrupted; nothing is left of " + out);
    files.append(bytes);
  };
}

void tell(const DriveCounts& counts, const ConvertOptions& options) {
  answer("{} scans, {} of them with reference pose, in {}\n", counts.scans, counts.references, options.out);
}

void copy_to_mcap(const ConvertOptions& options) {
  options.in.refuse_choices("all topics of a recording are copied to MCAP");
  ReadingBar bar;
  bags::Recording recording = options.in.open_recording();
  recording.tell_progress(bar.call());
  AtomicFiles files(options.force);
  files.add(options.out, "");
  const conversion::CopiedRecording copied =
      conversion::copy_recording(recording, sink_of(files, options.out));
  for (const std::string& text : recording.warnings()) warn(text);
  for (const std::string& remark : copied.remarks) warn(fmt::format("{}: {}", options.in.file, remark));
  files.commit();
  answer("{} messages in {}\n", copied.messages, options.out);
}

void to_mcap(const ConvertOptions& options) {
  if (kind_of_log(options.in.file) == LogKind::recording) return copy_to_mcap(options);
  ReadingBar bar;
  const auto reader = options.in.open(warn, bar.call());
  AtomicFiles files(options.force);
  files.add(options.out, "");
  conversion::McapDriveWriter writer(reader->sensors(), sink_of(files, options.out));
  const DriveCounts counts = conversion::pass_on(*reader, writer, options.in.file, warn);
  files.commit();
  tell(counts, options);
}

void to_carmen(const ConvertOptions& options) {
  const LogKind kind = kind_of_log(options.in.file);
  if (kind == LogKind::carmen)
    throw ConfigError(options.in.file, "is a CARMEN log already; name --out *.mcap");
  if (kind == LogKind::clouds)
    throw ConfigError(
        options.in.file,
        "has clouds, which cannot be written as a CARMEN log: it has planar scans only; name --out *.mcap");
  ReadingBar bar;
  const auto reader = options.in.open(warn, bar.call());
  AtomicFiles files(options.force);
  files.add(options.out, "");
  conversion::CarmenDriveWriter writer(reader->sensors(), options.in.file, sink_of(files, options.out));
  const DriveCounts counts = conversion::pass_on(*reader, writer, options.in.file, warn);
  files.commit();
  tell(counts, options);
}

/// Experiments take the sensor to be where the robot is unless they say something else.
void tell_mount(const Pose3& robot_from_sensor) {
  if (robot_from_sensor == Pose3{}) return;
  answer("the sensor's place: --set 'observations.cloud_drive.sensor={}'\n", mount_yaml(robot_from_sensor));
}

void to_folder(const ConvertOptions& options, const Context& context) {
  const LogKind kind = kind_of_log(options.in.file);
  if (kind == LogKind::clouds)
    throw ConfigError(options.in.file, "is a folder of clouds already; name --out *.mcap");
  if (kind == LogKind::carmen)
    throw ConfigError(options.in.file, "has planar scans, which are no clouds in space; name --out *.mcap");
  ReadingBar bar;
  const auto reader = options.in.open(warn, bar.call());
  const std::set<fs::path> inputs = options.in.inputs();
  OutputFolder folder(options.out, options.force, inputs);
  CloudFolderWriter writer(folder, options.in.file);
  const DriveCounts counts = conversion::pass_on(*reader, writer, options.in.file, warn);
  FileHashes hashes;
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
  throw ConfigError(options.out,
                    "the name says no format; name a file *.mcap or *.log (CARMEN), or a folder NAME/");
}

}  // namespace

void add_convert(CLI::App& app, Context& context) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "Write a recorded drive in another format: MCAP, CARMEN or clouds.");
  options->in.add_to(*command, "IN");
  command->add_option("-o,--out", options->out, "*.mcap, *.log (CARMEN), or a folder for clouds (NAME/)")
      ->required();
  command->add_flag("--force", options->force, "Replace what is there");
  command->callback([options, &context] { convert(*options, context); });
}

}  // namespace glocal::app
