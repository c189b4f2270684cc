#include "sources/clouds/cloud_file.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "glocal/extent.hpp"
#include "glocal/point_spread.hpp"
#include "sources/clouds/cloud_formats.hpp"

namespace glocal::clouds {
namespace {

/// The ending of a name, that of a compression left away.
std::string cloud_extension(std::filesystem::path file) {
  const std::string last = file.extension().string();
  if (last == ".gz" || last == ".bz2" || last == ".xz") file.replace_extension();
  return file.extension().string();
}

}  // namespace

bool has_name_of_cloud(const std::filesystem::path& file) {
  const std::string extension = cloud_extension(file);
  return extension == ".pcd" || extension == ".ply" || extension == ".bin";
}

Cloud read_cloud(const std::filesystem::path& file, const CloudOptions& options) {
  const std::string name = file.string();
  const std::string content = read_decompressed(file, options.max_size_gb);
  if (is_ply(content)) return read_ply_cloud(content, name, options);
  if (is_pcd(content)) return read_pcd_cloud(content, name, options);
  if (is_octree(content)) return read_octree_cloud(content, name, options);
  if (cloud_extension(file) == ".bin") return read_kitti_cloud(content, name, options);
  if (content.starts_with("LASF"))
    refuse_cloud(name, 0, "is a LAS file; convert it to PCD or PLY: pdal translate FILE.las FILE.ply");
  refuse_cloud(
      name, 0,
      "is neither a PCD file, a PLY file nor an octree (.bt) by its first line, nor a cloud of KITTI by "
      "its name (*.bin); "
      "convert it to one of them");
}

std::array<double, 3> principal_spreads(const Points& points) {
  const Vector3 middle = centroid(points);
  PointSums<double> sums;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 d = as_vector(points[i]) - middle;
    sums.add(d.x(), d.y(), d.z());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sums.covariance(), Eigen::EigenvaluesOnly);
  const Vector3 variances = solver.eigenvalues().cwiseMax(0.0).reverse();
  return {std::sqrt(variances[0]), std::sqrt(variances[1]), std::sqrt(variances[2])};
}

std::vector<std::string> cloud_remarks(const Cloud& cloud) {
  std::vector<std::string> remarks;
  if (cloud.not_finite > 0)
    remarks.push_back(fmt::format("{} of {} points have no finite coordinates; they are left out",
                                  cloud.not_finite, cloud.not_finite + cloud.points.size()));
  double extent = 0.0;
  float reach = 0.0F;
  for (const auto* axis : {&cloud.points.x, &cloud.points.y, &cloud.points.z}) {
    const Extent along = extent_of(*axis);
    extent = std::max(extent, along.length());
    reach = std::max({reach, std::abs(along.low), std::abs(along.high)});
  }
  // Few sites are larger in metres, and few rooms smaller in millimetres.
  constexpr double largest_site_m = 2000.0;
  if (extent > largest_site_m)
    remarks.push_back(
        fmt::format("extends over {:.0f} m; if it is in millimetres, set unit to 0.001", extent));
  const double rounding = std::nextafter(reach, std::numeric_limits<float>::infinity()) - reach;
  constexpr double fine_m = 0.005;
  if (rounding > fine_m)
    remarks.push_back(
        fmt::format("has points {:.0f} m from the origin, where places are rounded to {:.2g} "
                    "m; move the origin near the points",
                    reach, rounding));
  const std::array<double, 3> spreads = principal_spreads(cloud.points);
  constexpr double thin = 1e-3;  // Of the longest axis: well below a floor's waves and a sensor's noise.
  if (spreads[1] <= thin * spreads[0]) {
    remarks.push_back("all points lie on a line, or in one place");
  } else if (spreads[2] <= thin * spreads[0]) {
    remarks.push_back("all points lie in a plane");
  }
  return remarks;
}

}  // namespace glocal::clouds
