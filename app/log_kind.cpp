#include "app/log_kind.hpp"

#include <algorithm>

#include "glocal/error.hpp"
#include "sources/bags/recording.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

}  // namespace

void expect_there(const fs::path& path) {
  if (!fs::exists(path)) throw ConfigError({{path.string(), 0, 0, "there is no such file or folder"}});
}

LogKind kind_of_log(const fs::path& log) {
  expect_there(log);
  if (bags::is_recording(log)) return LogKind::recording;
  if (!fs::is_directory(log)) return LogKind::carmen;
  const fs::directory_iterator files(log);
  if (std::any_of(begin(files), end(files), [](const auto& file) { return has_name_of_cloud(file.path()); }))
    return LogKind::clouds;
  throw ConfigError({{log.string(), 0, 0, "is a folder with neither clouds nor .db3 or .mcap files"}});
}

fs::path odometry_of_clouds(const fs::path& folder) {
  for (const char* name : {"odometry.tum", "odom.tum"}) {
    if (fs::exists(folder / name)) return folder / name;
  }
  return {};
}

}  // namespace glocal::app
