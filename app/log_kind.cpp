#include "app/log_kind.hpp"

#include <algorithm>
#include <fstream>

#include "glocal/error.hpp"
#include "sources/bags/recording.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

bool is_folder_with(const fs::path& folder, bool (*is_wanted)(const fs::path&)) {
  if (!fs::is_directory(folder)) return false;
  const fs::directory_iterator files(folder);
  return std::any_of(begin(files), end(files), [&](const auto& file) { return is_wanted(file.path()); });
}

}  // namespace

std::string beginning_of(const fs::path& file) {
  if (!fs::exists(file)) throw ConfigError({{file.string(), 0, 0, "there is no such file or folder"}});
  if (fs::is_directory(file)) return "";
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(64, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

bool is_recording(const fs::path& path) {
  const auto is_part = [](const fs::path& file) {
    return file.extension() == ".db3" || file.extension() == ".mcap";
  };
  return bags::begins_recording(beginning_of(path)) || is_folder_with(path, is_part);
}

LogKind kind_of_log(const fs::path& log) {
  if (is_recording(log)) return LogKind::recording;
  if (is_folder_with(log, has_name_of_cloud)) return LogKind::clouds;
  if (fs::is_directory(log))
    throw ConfigError({{log.string(), 0, 0, "is a folder with neither clouds nor .db3 or .mcap files"}});
  return LogKind::carmen;
}

fs::path odometry_of_clouds(const fs::path& folder) {
  for (const char* name : {"odometry.tum", "odom.tum"}) {
    if (fs::exists(folder / name)) return folder / name;
  }
  return {};
}

}  // namespace glocal::app
