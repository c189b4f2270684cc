#include "sources/sites/office_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "glocal/pose2.hpp"

namespace glocal::sites {
namespace {

using simulation::World;

constexpr double module = 0.6;                // m; everything is a multiple of it
constexpr double outer_wall_thickness = 0.3;  // m
constexpr double door_offset = 0.75;          // m, from the nearer wall's middle to the door's
constexpr int pillar_modules = 12;            // from pillar to pillar

// In modules:
constexpr int usual_wing = 54;
constexpr int least_wing = 14;
constexpr int usual_band = 20;  // a corridor and the rows of rooms beside it
constexpr int least_depth = 6;
constexpr int most_depth = 11;  // with less, some sides could not be divided
constexpr int hall_width = 24;

struct RoomWidth {
  int modules;
  double weight;
  int longest_run;  ///< Of rooms of this width side by side.
};
constexpr std::array room_widths{
    RoomWidth{4, 0.12, 1},  RoomWidth{5, 0.2, 4},   RoomWidth{6, 0.34, 5},         RoomWidth{8, 0.2, 3},
    RoomWidth{10, 0.07, 2}, RoomWidth{12, 0.05, 1}, RoomWidth{hall_width, 0.02, 1}};
constexpr int styles = 4;

const RoomWidth& drawn_width(Rng& rng) {
  double left = rng.uniform();
  for (const RoomWidth& width : room_widths) {
    left -= width.weight;
    if (left < 0.0) return width;
  }
  return room_widths.front();  // the weights' sum is rounded
}

/// Whether rooms of 4, 5, 6 and more modules fill so many.
bool can_be_filled(int modules) {
  return modules == 0 || (modules >= 4 && modules != 7);
}

/// From `least` to `most`.
int drawn_between(int least, int most, Rng& rng) {
  return least + static_cast<int>(rng.below(static_cast<std::uint32_t>(most - least + 1)));
}

/// Lengths of wings, with the cross corridors between them.
std::vector<int> drawn_wings(int modules, Rng& rng) {
  const int n = std::max(2, static_cast<int>(std::lround(static_cast<double>(modules) / usual_wing)));
  std::vector<int> lengths(static_cast<std::size_t>(2 * n - 1));
  for (std::size_t i = 1; i < lengths.size(); i += 2) lengths[i] = drawn_between(3, 5, rng);
  const int rest = modules - std::accumulate(lengths.begin(), lengths.end(), 0);
  for (std::size_t i = 0; i < lengths.size(); i += 2) lengths[i] = rest / n;
  lengths.front() += rest % n;
  // From one wing to another, so that the sum stays.
  for (std::size_t i = 2; i < lengths.size(); i += 2) {
    const int most = std::min(lengths[i - 2], lengths[i]) - least_wing;
    const int modules_moved = drawn_between(-most / 2, most / 2, rng);
    lengths[i - 2] -= modules_moved;
    lengths[i] += modules_moved;
  }
  return lengths;
}

/// For each corridor the depths of the row below it, of itself and of the row above it.
std::vector<int> drawn_bands(int modules, Rng& rng) {
  const int n = static_cast<int>(std::lround(static_cast<double>(modules) / usual_band));
  std::vector<int> depths;
  for (int i = 0; i < n; ++i) {
    depths.push_back(drawn_between(7, 9, rng));
    depths.push_back(drawn_between(3, 4, rng));
    depths.push_back(drawn_between(7, 9, rng));
  }
  int rest = modules - std::accumulate(depths.begin(), depths.end(), 0);
  while (rest != 0) {
    const std::size_t i = rng.below(static_cast<std::uint32_t>(depths.size()));
    const int depth = depths[i] + (rest > 0 ? 1 : -1);
    if (i % 3 == 1 || depth < least_depth || depth > most_depth) continue;
    rest += depths[i] - depth;
    depths[i] = depth;
  }
  return depths;
}

std::vector<Span> spans(double from, const std::vector<int>& modules_of_each) {
  std::vector<Span> all;
  for (const int modules : modules_of_each) {
    all.push_back({from, from + modules * module});
    from = all.back().to;
  }
  return all;
}

RoomUse drawn_use(int modules, Rng& rng) {
  const double u = rng.uniform();
  switch (modules) {
    case hall_width:
      return RoomUse::hall;
    case 10:
    case 12:
      return u < 0.45 ? RoomUse::meeting : RoomUse::office;
    case 5:
      return u < 0.1 ? RoomUse::stairs : RoomUse::office;
    case 4:
      return u < 0.35 ? RoomUse::niche : RoomUse::storage;
    default:
      return RoomUse::office;
  }
}

Door drawn_door(RoomUse use, Rng& rng) {
  if (use == RoomUse::niche) return Door::none;
  const double u = rng.uniform();
  if (u < 0.06) return Door::opened_since;
  if (u < 0.12) return Door::shut_since;
  return u < 0.27 ? Door::shut : Door::open;
}

/// Rooms of a row along its corridor in a wing.
class RowOfRooms {
 public:
  RowOfRooms(OfficePlan& plan, std::size_t row, std::size_t wing)
      : plan_(plan), row_(row), wing_(wing), from_(plan.wings[wing].from) {}

  void fill(Rng rng) {
    int left = static_cast<int>(std::lround(plan_.wings[wing_].length() / module));
    while (left > 0) {
      const RoomWidth& width = drawn_width(rng);
      const int style = static_cast<int>(rng.below(styles));
      const bool alternates = rng.uniform() < 0.5;
      const int run = drawn_between(1, width.longest_run, rng);
      for (int i = 0; i < run && left >= width.modules && can_be_filled(left - width.modules); ++i) {
        add(width.modules, alternates && i % 2 == 1, style, rng);
        left -= width.modules;
      }
    }
  }

 private:
  void add(int modules, bool is_mirrored, int style, Rng& rng) {
    const Span& row = plan_.rows[row_];
    const bool is_above = row_ % 2 == 1;
    Room room;
    room.width = modules * module;
    room.depth = row.length();
    room.frame.origin = {is_mirrored ? from_ + room.width : from_, is_above ? row.from : row.to};
    room.frame.x_axis = {is_mirrored ? -1.0 : 1.0, 0.0};
    room.frame.y_axis = {0.0, is_above ? 1.0 : -1.0};
    room.use = drawn_use(modules, rng);
    room.state = drawn_door(room.use, rng);
    room.door = room.use == RoomUse::niche ? room.width / 2.0 : door_offset;
    room.style = style;
    room.corridor = row_ / 2;
    room.wing = wing_;
    plan_.rooms.push_back(room);
    from_ += room.width;
  }

  OfficePlan& plan_;
  std::size_t row_;
  std::size_t wing_;
  double from_;
};

/// A box between two places.
void add_box(const simulation::Position& a, const simulation::Position& b, World& world) {
  world.rectangles.push_back({.centre = {(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0},
                              .size = {std::abs(b[0] - a[0]), std::abs(b[1] - a[1])}});
}

/// A wall around a line along x, or along y.
void add_wall_along_x(const Span& x, double y, double thickness, World& world) {
  add_box({x.from, y - thickness / 2.0}, {x.to, y + thickness / 2.0}, world);
}
void add_wall_along_y(double x, const Span& y, double thickness, World& world) {
  add_box({x - thickness / 2.0, y.from}, {x + thickness / 2.0, y.to}, world);
}

/// The wall to the corridor, beside the door.
void add_front(const Room& room, World& world) {
  const double half = wall_thickness / 2.0;
  const auto add = [&](double from, double to) {
    add_box(room.frame.at(from, -half), room.frame.at(to, half), world);
  };
  if (room.use == RoomUse::niche) return;
  add(0.0, room.door - door_width / 2.0);
  add(room.door + door_width / 2.0, room.width);
}

/// A leaf, which turns about the side of the door that is nearer to a wall.
void add_leaf(const Room& room, double angle, simulation::Presence presence, World& world) {
  const double hinge = room.door - door_width / 2.0;
  world.walls.push_back(
      {.points = {room.frame.at(hinge, 0.0),
                  room.frame.at(hinge + door_width * std::cos(angle), door_width * std::sin(angle))},
       .presence = presence});
}

void add_door(const Room& room, Rng rng, World& world) {
  const auto drawn_angle = [&] { return radians(rng.uniform(84.0, 103.0)); };
  constexpr simulation::Presence only_on_map{true, false};
  constexpr simulation::Presence only_in_reality{false, true};
  const double mapped = drawn_angle();
  const double real = drawn_angle();
  switch (room.state) {
    case Door::none:
      return;
    case Door::shut:
      return add_leaf(room, 0.0, {}, world);
    case Door::open:
      if (rng.uniform() < 0.6) return add_leaf(room, mapped, {}, world);
      add_leaf(room, mapped, only_on_map, world);
      return add_leaf(room, real, only_in_reality, world);
    case Door::opened_since:
      add_leaf(room, 0.0, only_on_map, world);
      return add_leaf(room, real, only_in_reality, world);
    case Door::shut_since:
      add_leaf(room, mapped, only_on_map, world);
      return add_leaf(room, 0.0, only_in_reality, world);
  }
}

/// In walls between rooms that lie back to back, and in the outer walls behind rooms.
void add_pillars(const OfficePlan& plan, World& world) {
  std::vector<double> lines{plan.y.from, plan.y.to};
  for (std::size_t row = 2; row < plan.rows.size(); row += 2) lines.push_back(plan.rows[row].from);
  constexpr double half = pillar_side / 2.0;
  for (const double x : plan.pillars) {
    for (const double y : lines) add_box({x - half, y - half}, {x + half, y + half}, world);
  }
}

/// Evenly spaced, but for cross corridors.
std::vector<double> pillars_of(const OfficePlan& plan) {
  constexpr double spacing = pillar_modules * module;
  constexpr double half = pillar_side / 2.0;
  std::vector<double> pillars;
  for (double x = plan.x.from + spacing; x < plan.x.to; x += spacing) {
    const auto is_in_wing = [&](const Span& wing) { return x - half > wing.from && x + half < wing.to; };
    if (std::ranges::any_of(plan.wings, is_in_wing)) pillars.push_back(x);
  }
  return pillars;
}

}  // namespace

double Room::way_in() const {
  constexpr double room_to_turn = 1.1;  // m
  constexpr double farthest = 2.8;
  if (state != Door::open || use == RoomUse::stairs) return 0.0;
  return std::min(depth - room_to_turn, farthest);
}

OfficePlan office_plan(double side, Rng rng) {
  const int modules = static_cast<int>(std::floor((side - outer_wall_thickness) / module));
  const double margin = (side - modules * module) / 2.0;
  OfficePlan plan;
  plan.x = plan.y = {margin, margin + modules * module};
  const std::vector<Span> along = spans(margin, drawn_wings(modules, rng));
  for (std::size_t i = 0; i < along.size(); ++i)
    (i % 2 == 0 ? plan.wings : plan.cross_corridors).push_back(along[i]);
  const std::vector<Span> across = spans(margin, drawn_bands(modules, rng));
  for (std::size_t i = 0; i < across.size(); ++i)
    (i % 3 == 1 ? plan.corridors : plan.rows).push_back(across[i]);
  plan.pillars = pillars_of(plan);
  for (std::size_t row = 0; row < plan.rows.size(); ++row) {
    for (std::size_t wing = 0; wing < plan.wings.size(); ++wing)
      RowOfRooms(plan, row, wing).fill(rng.stream({row, wing}));
  }
  return plan;
}

void add_walls(const OfficePlan& plan, Rng rng, World& world) {
  for (const double y : {plan.y.from, plan.y.to}) add_wall_along_x(plan.x, y, outer_wall_thickness, world);
  for (const double x : {plan.x.from, plan.x.to}) add_wall_along_y(x, plan.y, outer_wall_thickness, world);
  for (const Span& wing : plan.wings) {
    for (std::size_t row = 2; row < plan.rows.size(); row += 2)
      add_wall_along_x(wing, plan.rows[row].from, wall_thickness, world);
  }
  for (const Span& cross : plan.cross_corridors) {
    for (const Span& row : plan.rows) {
      add_wall_along_y(cross.from, row, wall_thickness, world);
      add_wall_along_y(cross.to, row, wall_thickness, world);
    }
  }
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const Room& room = plan.rooms[i];
    const bool has_neighbour = i + 1 < plan.rooms.size() && plan.rooms[i + 1].wing == room.wing &&
                               plan.rooms[i + 1].frame.origin[1] == room.frame.origin[1];
    const double right = std::max(room.frame.origin[0], room.frame.at(room.width, 0.0)[0]);
    const double low = std::min(room.frame.origin[1], room.frame.at(0.0, room.depth)[1]);
    if (has_neighbour) add_wall_along_y(right, {low, low + room.depth}, wall_thickness, world);
    add_front(room, world);
    add_door(room, rng.stream({i}), world);
  }
  add_pillars(plan, world);
}

}  // namespace glocal::sites
