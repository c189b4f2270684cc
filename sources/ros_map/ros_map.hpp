// Maps of the ROS map server: a YAML file and an image.
#pragma once

#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"

namespace glocal::ros_map {

/// The YAML file of a map server.
struct RosMapFile {
  FilePath image;
  double resolution = 0.0;
  std::vector<double> origin;
  std::string negate = "0";  ///< As map servers take it: a number, or a truth value.
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  std::string mode = "trinary";
};
void describe(ParamVisitor& v, RosMapFile& p);

/// A map server's map. A pixel's darkness decides: from occupied_thresh on the cell is occupied, up to
/// free_thresh it is free.
class RosMap final : public MapSource {
 public:
  struct Params {
    FilePath path;
  };

  RosMap(const Params& params, const SourceSetup& setup);

  /// Each occupied cell's centre is a point. Throws ConfigError for a faulty file or image, or a map without
  /// occupied cell.
  [[nodiscard]] MapData load() override;

 private:
  RosMapFile file_;
  std::string name_;
};
void describe(ParamVisitor& v, RosMap::Params& p);

}  // namespace glocal::ros_map
