// Maps, clouds and logs whose contents are drawn, as files in the folder of this process.
#pragma once

#include <string>

#include "fuzz/draw.hpp"

namespace glocal::fuzz {

struct DrawnMap {
  std::string file;
  std::string source;  ///< As an experiment has it.
};

/// A map server's, a cloud or an octree.
[[nodiscard]] DrawnMap drawn_map(Draw& draw);
[[nodiscard]] std::string drawn_pcd(Draw& draw, const std::string& name);
/// A CARMEN log of three scans, drive.log.
[[nodiscard]] std::string drawn_log(Draw& draw);

}  // namespace glocal::fuzz
