#include "app/log_kind.hpp"

#include <algorithm>
#include <cctype>

#include "glocal/error.hpp"
#include "sources/bags/recording.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::app {

namespace fs = std::filesystem;

void expect_there(const fs::path& path) {
  if (!fs::exists(path)) throw ConfigError(path, "there is no such file or folder");
}

LogKind kind_of_log(const fs::path& log) {
  expect_there(log);
  if (bags::is_recording(log)) return LogKind::recording;
  if (!fs::is_directory(log)) return LogKind::carmen;
  const fs::directory_iterator files(log);
  if (std::any_of(begin(files), end(files),
                  [](const auto& file) { return clouds::has_name_of_cloud(file.path()); }))
    return LogKind::clouds;
  throw ConfigError(log, "is a folder with neither clouds nor .db3 or .mcap files");
}

fs::path odometry_of_clouds(const fs::path& folder) {
  for (const char* name : {"odometry.tum", "odom.tum"}) {
    if (fs::exists(folder / name)) return folder / name;
  }
  return {};
}

std::string plain_name(const fs::path& log) {
  const fs::path path = fs::absolute(log).lexically_normal();
  std::string name = (path.has_filename() ? path : path.parent_path()).filename().string();
  name = name.substr(0, name.find('.'));
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
  }
  constexpr std::size_t longest = 80;
  return name.empty() ? "drive" : name.substr(0, longest);
}

}  // namespace glocal::app
