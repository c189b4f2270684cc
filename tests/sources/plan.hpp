// Hand-made ROS maps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files.hpp"
#include "sources/ros_map/ros_map.hpp"

namespace glocal::test {

/// A ROS map of rows of cells of 0.5 m, the highest y first: # occupied, . free, ? unknown.
class Plan {
 public:
  explicit Plan(const std::vector<std::string>& rows, const std::string& origin = "[0, 0, 0]") {
    std::string image = "P5 " + std::to_string(rows[0].size()) + " " + std::to_string(rows.size()) + " 255\n";
    for (const std::string& row : rows) {
      for (const char cell : row) image += static_cast<char>(cell == '#' ? 0 : cell == '.' ? 254 : 205);
    }
    folder_.write("map.pgm", image);
    file_ = folder_.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: " + origin + "\n");
  }

  [[nodiscard]] FilePath file() const { return file_path(file_); }
  [[nodiscard]] std::filesystem::path folder() const { return file_.parent_path(); }
  [[nodiscard]] OccupancyGrid grid() const { return ros_map::RosMap({file()}, {}).load().grid; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
};

/// 6 m x 3.5 m, with a pillar and a hole in the wall at the right.
inline const std::vector<std::string> room_plan{
    "?##########?",  //
    "#..........#",  //
    "#..........#",  //
    "#....#.....#",  //
    "#..........#",  //
    "#..........?",  //
    "?##########?",
};

}  // namespace glocal::test
