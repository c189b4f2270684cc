// glocal map: build maps from logs, convert maps, show what is in them.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "config/overrides.hpp"
#include "config/reader.hpp"
#include "config/text_file.hpp"
#include "config/yaml_parser.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/error.hpp"
#include "sources/carmen/log_map.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/ros_map/ros_map_writer.hpp"

namespace glocal::app {
namespace {

struct MapOptions {
  ExperimentOptions input;
  std::string out;
  std::string image;  ///< Empty: pgm.
  bool force = false;
};

/// A map server's file names an image; an experiment does not.
bool is_ros_map(const std::string& file) {
  std::vector<Fault> faults;
  const auto tree = parse_yaml(read_text_file(file), origin_of(file), faults);
  return tree && tree->kind == NodeKind::map && find_entry(*tree, "image") != nullptr;
}

/// The map of a file; `input` has what may be changed in it.
MapData load(const ExperimentOptions& input, Context& context) {
  const std::string extension = std::filesystem::path(input.file).extension().string();
  if (extension != ".yaml" && extension != ".yml")
    throw ConfigError(input.file,
                      "is no YAML file; name a ROS map's, or that of an experiment whose map is meant");
  if (!is_ros_map(input.file)) return load_map(input.read(context), context.catalog, {.warn = warn});
  if (!input.words().empty())
    throw ConfigError(input.file,
                      "is a ROS map, in which nothing can be changed; leave out " + input.words().front());
  return ros_map::RosMap({{input.file, input.file}}, {.warn = warn}).load();
}

/// The parameters of log_map, from `--set name=value`.
carmen::LogMap::Params log_map_params(const ExperimentOptions& input) {
  const auto origin = std::make_shared<Origin>(Origin{"map build", std::filesystem::current_path()});
  const Place place{origin};
  YamlNode path = make_scalar(place, input.file);
  path.quoted = true;
  YamlNode tree = make_node(NodeKind::map, place);
  tree.entries.push_back({"path", place, std::move(path)});
  ParamsOf<carmen::LogMap::Params> params;
  fill(params, std::move(tree), input.overrides());
  return std::move(params.value);
}

void write(const MapData& map, const MapOptions& options) {
  const std::filesystem::path out(options.out);
  AtomicFiles files(options.force);
  if (out.extension() == ".pcd") {
    if (!options.image.empty())
      throw ConfigError(options.out, "points have no image; leave out --image, or name a .yaml file");
    files.add(out, pcd(map.points, map.origin));
  } else if (out.extension() == ".yaml") {
    if (map.grid.cells.empty())
      throw ConfigError(options.out, "the map has points and no cells; name a .pcd file");
    const ros_map::ByteImage image = ros_map::trinary_image(map.grid);
    const std::filesystem::path image_file =
        std::filesystem::path(out).replace_extension(options.image.empty() ? "pgm" : options.image);
    files.add(image_file, options.image == "png" ? ros_map::png(image) : ros_map::pgm(image));
    files.add(out, ros_map::ros_map_yaml(map.grid, image_file.filename().string(), map.origin));
  } else {
    throw ConfigError(options.out, "the name must end in .yaml (ROS map) or .pcd (points)");
  }
  files.commit();
}

std::string range_of(const std::vector<float>& values, double origin) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:.2f} to {:.2f}", origin + *low, origin + *high);
}

void show(const MapData& map) {
  const OccupancyGrid& grid = map.grid;
  const auto cells = [&](Cell kind) { return std::count(grid.cells.begin(), grid.cells.end(), kind); };
  answer("cells       {} x {} of {} m: {:.2f} m x {:.2f} m\n", grid.width, grid.height, grid.resolution,
         grid.width * grid.resolution, grid.height * grid.resolution);
  answer("origin      x {:.3f} m, y {:.3f} m, yaw {:.2f} deg\n", map.origin.x() + grid.map_from_grid.x,
         map.origin.y() + grid.map_from_grid.y, degrees(grid.map_from_grid.theta));
  answer("occupied    {}\nfree        {} ({:.1f} m^2)\nunknown     {}\n", cells(Cell::occupied),
         cells(Cell::free), static_cast<double>(cells(Cell::free)) * grid.resolution * grid.resolution,
         cells(Cell::unknown));
  answer("points      {}: x {} m, y {} m\n", map.points.size(), range_of(map.points.x, map.origin.x()),
         range_of(map.points.y, map.origin.y()));
  answer("path        {} poses\n", map.path.size());
}

struct AlignOptions {
  ExperimentOptions map;
  ExperimentOptions other;
  double contact_epsilon = 0.15;
};

/// Random sample matching of whole maps: they have room for large triangles, which say more.
StrategyChoice matcher_of_maps(const Catalog& catalog, double contact_epsilon) {
  StrategyChoice choice = catalog.matchers.choose("ransam");
  const std::string epsilon = fmt::format("{}", contact_epsilon);
  const auto origin = std::make_shared<Origin>(Origin{"map align", std::filesystem::current_path()});
  fill(*choice.params, make_node(NodeKind::null, {origin}),
       {{"iterations", "2000000"},
        {"contact_epsilon", epsilon},
        {"relation_cell", epsilon},
        {"min_side", "3"},
        {"min_height", "1"}});
  return choice;
}

struct Alignment {
  Pose2 map_from_other;
  double in_contact;  ///< Share of the other map's points.
};

/// Lays points on a map by a matcher that was made for it, then by Gauss-Newton on the distance field. None
/// if the matcher finds no pose that it scores at least 0.25.
std::optional<Alignment> align_maps(const GlobalMap& map, const Points& other, Matcher& matcher,
                                    double contact_epsilon) {
  LocalMap local;
  local.points = other;
  local.ends = {other.size()};
  Rng rng(1);
  // Maps of one place may have little in common: furniture, rooms behind doors.
  for (const double omega_max : {0.6, 0.4, 0.25}) {
    const MatchResult result = matcher.match({local, {}, omega_max}, rng);
    if (result.hypotheses.empty()) continue;
    const Pose2 map_from_other =
        refined_pose(DistanceField(map.points()), other,
                     seen_from_above(result.hypotheses.front().map_from_local), {.iterations = 100});
    const auto contact = contact_index(map, "bitset", contact_epsilon);
    return Alignment{map_from_other, contact->share(other, Transform(map_from_other))};
  }
  return std::nullopt;
}

void align(const AlignOptions& options, Context& context) {
  const auto map = std::make_shared<const GlobalMap>(load(options.map, context));
  const MapData other = load(options.other, context);
  const StrategyChoice choice = matcher_of_maps(context.catalog, options.contact_epsilon);
  const auto matcher = context.catalog.matchers.make(choice, {map, 1});
  const auto found = align_maps(*map, other.points, *matcher, options.contact_epsilon);
  if (!found) {
    throw RunError(fmt::format(
        "{} does not fit into {}: no pose brings a quarter of its points within {} m of the map's",
        options.other.file, options.map.file, options.contact_epsilon));
  }
  const Pose2 p = found->map_from_other * Pose2{-other.origin.x(), -other.origin.y(), 0.0};
  answer("pose        [{:.3f}, {:.3f}, {:.3f}]: x, y (m), yaw (deg) of {} in {}\n", map->origin().x() + p.x,
         map->origin().y() + p.y, degrees(p.theta), options.other.file, options.map.file);
  answer("contact     {:.1f} % of its points within {} m\n", 100.0 * found->in_contact,
         options.contact_epsilon);
}

void add_output(CLI::App& command, MapOptions& options) {
  command.add_option("-o,--out", options.out, "NAME.yaml: ROS map with its image; NAME.pcd: points")
      ->required();
  command.add_option("--image", options.image, "Kind of the ROS map's image")
      ->check(CLI::IsMember({"pgm", "png"}));
  command.add_flag("--force", options.force, "Replace files that exist");
}

}  // namespace

void add_map(CLI::App& app, Context& context) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* map = app.add_subcommand("map", "Build, convert and look at maps.");
  map->require_subcommand(1);

  CLI::App* build = map->add_subcommand("build", "Build a map from a CARMEN log with reference poses.");
  build->add_option("LOG", options->input.file, "CARMEN log")->required();
  options->input.add_set_to(*build, "Change a parameter of log_map: segments=[[0,0.3]] (repeatable)");
  add_output(*build, *options);
  build->callback(
      [options] { write(carmen::LogMap(log_map_params(options->input), {.warn = warn}).load(), *options); });

  constexpr const char* file = "ROS map (YAML), or experiment whose map is meant";
  CLI::App* convert = map->add_subcommand("convert", "Write a map in another format.");
  convert->add_option("FILE", options->input.file, file)->required();
  options->input.add_overrides_to(*convert);
  add_output(*convert, *options);
  convert->callback([options, &context] { write(load(options->input, context), *options); });

  auto aligned = std::make_shared<AlignOptions>();
  CLI::App* align_command = map->add_subcommand("align", "Find out where one map lies in another.");
  align_command->add_option("MAP", aligned->map.file, file)->required();
  align_command->add_option("OTHER", aligned->other.file, file)->required();
  align_command->add_option("--epsilon", aligned->contact_epsilon, "Distance that counts as contact, m")
      ->check(within(0.01, 1.0));
  align_command->callback([aligned, &context] { align(*aligned, context); });

  CLI::App* info = map->add_subcommand("info", "Show size, cells and points of a map.");
  info->add_option("FILE", options->input.file, file)->required();
  options->input.add_overrides_to(*info);
  info->callback([options, &context] { show(load(options->input, context)); });
}

}  // namespace glocal::app
