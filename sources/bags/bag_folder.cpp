#include "sources/bags/bag_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/yaml.hpp"

namespace glocal::bags {

namespace fs = std::filesystem;

/// What of metadata.yaml is used; rosbag2 writes more, and not the same in all versions.
struct TopicMetadata {
  std::string name = {};
};
void describe(ParamVisitor& v, TopicMetadata& p) {
  v.field("name", p.name, {.doc = "topic"});
}

struct TopicCount {
  TopicMetadata topic = {};
  std::uint64_t messages = 0;
};
void describe(ParamVisitor& v, TopicCount& p) {
  v.field("topic_metadata", p.topic, {.doc = "which topic"});
  v.field("message_count", p.messages, {.doc = "its messages"});
}

struct BagInformation {
  std::vector<std::string> files = {};
  std::vector<TopicCount> topics = {};
  std::string compression_mode = {}, compression_format = {};
};
void describe(ParamVisitor& v, BagInformation& p) {
  v.field("relative_file_paths", p.files, {.doc = "files"});
  v.field("topics_with_message_count", p.topics, {.doc = "topics"});
  v.field("compression_mode", p.compression_mode, {.doc = "what is compressed"});
  v.field("compression_format", p.compression_format, {.doc = "how it is compressed"});
}

struct BagMetadata {
  BagInformation information = {};
};
void describe(ParamVisitor& v, BagMetadata& p) {
  v.field("rosbag2_bagfile_information", p.information, {.doc = "all", .required = true});
}

namespace {

constexpr const char* metadata_name = "metadata.yaml";
constexpr const char* packed_extension = ".zstd";

bool is_packed(const fs::path& file) {
  return file.extension() == packed_extension;
}

bool is_part(const fs::path& file) {
  const fs::path extension = is_packed(file) ? file.stem().extension() : file.extension();
  return extension == ".db3" || extension == ".mcap";
}

/// The parts of a recording in a folder, in the order of their names.
std::vector<fs::path> parts_in(const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_part(entry.path())) parts.push_back(entry.path());
  }
  std::ranges::sort(parts);
  return parts;
}

bool is_metadata(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  return std::getline(stream, line) && line.starts_with("rosbag2_bagfile_information");
}

BagInformation read_metadata(const fs::path& file) {
  ParamsOf<BagMetadata> metadata;
  try {
    read_yaml(file, metadata, OtherKeys::passed_over);
  } catch (const ConfigError& error) {
    std::vector<Fault> faults = error.faults();
    faults.back().message +=
        "; make the file anew with ROS (ros2 bag reindex), or delete it: all files of the folder are then "
        "read";
    throw ConfigError(std::move(faults));
  }
  const BagInformation& information = metadata.value.information;
  const std::string& format = information.compression_format;
  if (!information.compression_mode.empty() && information.compression_mode != "NONE" && format != "zstd")
    throw ConfigError(
        file,
        fmt::format("says that the recording is compressed with '{}'; only zstd can be read: write it anew "
                    "with ROS (ros2 bag convert)",
                    format));
  return information;
}

/// Throws ConfigError for all parts that are compressed as a whole and have not been unpacked.
std::vector<fs::path> unpacked_parts(const std::vector<fs::path>& parts) {
  std::vector<fs::path> files;
  std::vector<Fault> faults;
  for (fs::path file : parts) {
    if (is_packed(file) && fs::exists(fs::path(file).replace_extension())) file.replace_extension();
    if (is_packed(file))
      faults.push_back({file.string(), 0, 0,
                        fmt::format("is compressed as a whole; unpack it: zstd -d {}", file.string())});
    if (std::ranges::find(files, file) == files.end()) files.push_back(file);
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return files;
}

/// Older versions of rosbag2 write the folder's name before the file's.
std::vector<fs::path> named_parts(const BagInformation& information, const fs::path& folder) {
  std::vector<fs::path> parts;
  std::vector<Fault> faults;
  for (const std::string& name : information.files) {
    const fs::path part = folder / fs::path(name).filename();
    const bool is_there =
        fs::exists(part) || (is_packed(part) && fs::exists(fs::path(part).replace_extension()));
    if (!is_there)
      faults.push_back({(folder / metadata_name).string(), 0, 0,
                        fmt::format("names {}, which is not there; put it into the folder, or make {} anew "
                                    "of the files that are there, with ROS (ros2 bag reindex)",
                                    part.filename().string(), metadata_name)});
    parts.push_back(part);
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return parts;
}

}  // namespace

bool is_bag_folder(const fs::path& folder) {
  return is_metadata(folder / metadata_name) || !parts_in(folder).empty();
}

BagFolder read_bag_folder(const fs::path& folder) {
  const std::vector<fs::path> there = parts_in(folder);
  const fs::path metadata = folder / metadata_name;
  const BagInformation information = is_metadata(metadata) ? read_metadata(metadata) : BagInformation{};
  if (information.files.empty() && there.empty())
    throw ConfigError(folder, "is a folder without .db3 or .mcap files; a recording of ROS 2 has them");
  BagFolder bag;
  bag.files = unpacked_parts(information.files.empty() ? there : named_parts(information, folder));
  for (const TopicCount& topic : information.topics) bag.messages[topic.topic.name] += topic.messages;
  if (information.files.empty()) return bag;
  for (const fs::path& part : there) {
    const bool is_named = std::ranges::any_of(bag.files, [&](const fs::path& file) {
      return part == file || part == file.string() + packed_extension;
    });
    if (!is_named)
      bag.warnings.push_back(
          fmt::format("{}: is left out, as {} does not name it", part.string(), metadata_name));
  }
  return bag;
}

}  // namespace glocal::bags
