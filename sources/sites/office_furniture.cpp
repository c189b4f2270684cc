#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/pose2.hpp"
#include "sources/sites/office_plan.hpp"

namespace glocal::sites {
namespace {

using simulation::Position;
using simulation::World;

// Lengths in m.
constexpr double furniture_gap = 0.03;                           // between pieces, and to walls
constexpr double margin = wall_thickness / 2.0 + furniture_gap;  // from the middle of a wall
constexpr double lane_half = 0.32;                               // of ways that stay free
constexpr double chair_diameter = 0.5;
constexpr int most_draws = 20;  // for a place

// How far rooms that are alike differ.
constexpr double omitted = 0.12;      // share of the usual furniture that a room does not have
constexpr double shift = 0.06;        // standard deviation from where a piece usually stands, m
constexpr double rotation_deg = 1.5;  // the same of angles
constexpr double shafts = 0.15;       // share of rooms with a shaft in a corner

// What has changed since the map was made.
constexpr double moved = 0.10;  // shares of all pieces
constexpr double moved_chairs = 0.6;
constexpr double removed = 0.08;
constexpr double additions = 0.35;  // share of rooms with a piece more

/// What is `built` never moves.
enum class Kind { box, chair, built };

/// Something that stands in an area, along its axes but for a small angle.
struct Piece {
  Position centre{};
  Position size{};  ///< Of a chair, its diameter twice.
  Kind kind = Kind::box;
  double angle_deg = 0.0;
};

bool overlap(const Piece& a, const Piece& b) {
  return std::abs(a.centre[0] - b.centre[0]) < (a.size[0] + b.size[0]) / 2.0 + furniture_gap &&
         std::abs(a.centre[1] - b.centre[1]) < (a.size[1] + b.size[1]) / 2.0 + furniture_gap;
}

/// What reaches from one corner to the opposite one.
Piece between_corners(const Position& a, const Position& b) {
  return {.centre = simulation::between(a, b, 0.5), .size = {std::abs(b[0] - a[0]), std::abs(b[1] - a[1])}};
}

enum class Side { front, back, left, right };

/// A room, or a part of a corridor, between the middles of its walls.
struct Area {
  Frame frame;
  Position size{};  ///< Width and depth, m.
  std::uint32_t sides_with_walls = 4;
  std::vector<Piece> keep_free = {};
};

/// Furniture for an area, none of it in the way of other.
class Layout {
 public:
  Layout(Area area, Rng rng) : area_(std::move(area)), rng_(rng) {}

  /// Whether there was room.
  bool put(const Piece& piece) {
    const auto is_in_the_way = [&](const Piece& other) { return overlap(piece, other); };
    const bool fits = is_within_walls(piece) && std::ranges::none_of(area_.keep_free, is_in_the_way) &&
                      std::ranges::none_of(pieces_, is_in_the_way);
    if (fits) pieces_.push_back(piece);
    return fits;
  }

  /// Puts a box with its length along a wall; where there is a chair, it stands before the box.
  void put_along_wall(double length, double depth, bool has_chair = false) {
    const auto side = static_cast<Side>(rng_.below(area_.sides_with_walls));
    const std::size_t along = side == Side::front || side == Side::back ? 0 : 1;
    const std::size_t across = 1 - along;
    const bool is_far = side == Side::back || side == Side::right;
    const double from_wall = margin + depth / 2.0;
    Piece box;
    box.centre[across] = is_far ? area_.size[across] - from_wall : from_wall;
    box.size[along] = length;
    box.size[across] = depth;
    const double least = margin + length / 2.0;
    const bool has_room = try_places([&] {
      box.centre[along] = rng_.uniform(least, area_.size[along] - least);
      return put(box);
    });
    if (has_room && has_chair) put_chair_at(box, across, is_far ? -1.0 : 1.0);
  }

  void put_chair_at(const Piece& box, std::size_t axis, double direction) {
    Piece chair{.centre = box.centre, .size = {chair_diameter, chair_diameter}, .kind = Kind::chair};
    chair.centre[axis] += direction * (box.size[axis] / 2.0 + 0.3);
    chair.centre[1 - axis] += rng_.uniform(-0.3, 0.3);
    put(chair);
  }

  void put_anywhere(Piece piece) {
    try_places([&] {
      piece.centre = {rng_.uniform(0.0, area_.size[0]), rng_.uniform(0.0, area_.size[1])};
      return put(piece);
    });
  }

  /// Puts a piece beside where it stands.
  void put_beside(const Piece& piece) {
    try_places([&] {
      Piece other = piece;
      for (double& x : other.centre) x += rng_.uniform(-1.5, 1.5);
      return put(other);
    });
  }

  /// A shaft in one of the corners farthest from the corridor.
  void put_shaft() {
    static constexpr std::array<Position, 3> sizes{{{0.5, 0.5}, {0.9, 0.4}, {0.6, 1.0}}};
    Piece shaft{.centre = {}, .size = sizes[rng_.below(3)], .kind = Kind::built};
    shaft.centre = {margin + shaft.size[0] / 2.0, area_.size[1] - margin - shaft.size[1] / 2.0};
    if (rng_.uniform() < 0.5) shaft.centre[0] = area_.size[0] - shaft.centre[0];
    put(shaft);
  }

  [[nodiscard]] const Area& area() const { return area_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] Rng& rng() { return rng_; }

 private:
  [[nodiscard]] bool is_within_walls(const Piece& piece) const {
    const auto is_within = [&](std::size_t axis) {
      const double reach = piece.size[axis] / 2.0 + wall_thickness / 2.0;
      return piece.centre[axis] > reach && piece.centre[axis] < area_.size[axis] - reach;
    };
    return is_within(0) && is_within(1);
  }

  template <class Try>
  static bool try_places(Try put_somewhere) {
    for (int draw = 0; draw < most_draws; ++draw) {
      if (put_somewhere()) return true;
    }
    return false;
  }

  Area area_;
  Rng rng_;
  std::vector<Piece> pieces_;
};

void put_cabinets(int count, double depth, Layout& layout) {
  static constexpr std::array lengths{0.8, 1.2, 1.6};
  for (int i = 0; i < count; ++i) layout.put_along_wall(lengths[layout.rng().below(3)], depth);
}

void put_table_with_chairs(Layout& layout) {
  const Position& size = layout.area().size;
  const Piece table{.centre = {size[0] / 2.0 + layout.rng().uniform(0.0, 0.6), size[1] / 2.0 + 0.3},
                    .size = {size[0] > 6.5 ? 3.2 : 2.4, 1.2}};
  if (!layout.put(table)) return;
  for (const double share : {-0.33, 0.0, 0.33}) {
    Piece part = table;
    part.centre[0] += share * table.size[0];
    for (const double direction : {-1.0, 1.0}) layout.put_chair_at(part, 1, direction);
  }
}

void put_pillars(Layout& layout) {
  const Position& size = layout.area().size;
  for (double x = 2.4; x < size[0] - 1.0; x += 4.8) {
    for (double y = 1.8; y < size[1] - 1.0; y += 3.6)
      layout.put({.centre = {x, y}, .size = {0.45, 0.45}, .kind = Kind::built});
  }
}

/// What rooms of a use, size and style usually have.
std::vector<Piece> usual_furniture(const Area& area, RoomUse use, Rng rng) {
  Layout layout(area, rng);
  const double square_metres = area.size[0] * area.size[1];
  switch (use) {
    case RoomUse::office:
      for (int i = 0; i < std::max(1, static_cast<int>(square_metres / 9.0)); ++i)
        layout.put_along_wall(1.6, 0.8, true);
      put_cabinets(1 + static_cast<int>(square_metres / 12.0), 0.42, layout);
      break;
    case RoomUse::meeting:
      put_table_with_chairs(layout);
      put_cabinets(2, 0.42, layout);
      break;
    case RoomUse::storage:
      put_cabinets(5, 0.5, layout);
      break;
    case RoomUse::stairs:
      layout.put({.centre = {area.size[0] / 2.0, area.size[1] / 2.0 + 0.5},
                  .size = {0.25, area.size[1] - 2.2},
                  .kind = Kind::built});
      break;
    case RoomUse::niche:
      put_cabinets(2, 0.6, layout);
      break;
    case RoomUse::hall:
      put_pillars(layout);
      for (int i = 0; i < 7; ++i) layout.put_anywhere({.centre = {}, .size = {i % 2 == 0 ? 0.8 : 1.6, 0.8}});
      put_cabinets(4, 0.42, layout);
      break;
  }
  return layout.pieces();
}

/// Puts a piece near where it usually stands; not all rooms have it.
void put_usual(const Piece& piece, Layout& layout) {
  if (piece.kind != Kind::built) {
    Rng& rng = layout.rng();
    if (rng.uniform() < omitted) return;
    Piece shifted = piece;
    for (double& x : shifted.centre) x += rng.normal(shift);
    shifted.angle_deg = rng.normal(rotation_deg);
    if (layout.put(shifted)) return;
  }
  layout.put(piece);
}

void put_own(Layout& layout) {
  static constexpr std::array lengths{0.4, 0.6, 0.8, 1.2};
  const std::uint32_t count = layout.rng().below(3);
  for (std::uint32_t i = 0; i < count; ++i) layout.put_along_wall(lengths[layout.rng().below(4)], 0.4);
}

void add_to_world(const Piece& piece, const Frame& frame, simulation::Presence presence, World& world) {
  const Position at = frame.at(piece.centre[0], piece.centre[1]);
  if (piece.kind == Kind::chair) {
    world.circles.push_back({.centre = {at[0], at[1]}, .radius = piece.size[0] / 2.0, .presence = presence});
    return;
  }
  world.rectangles.push_back(
      {.centre = {at[0], at[1]},
       .size = {piece.size[0], piece.size[1]},
       .angle_deg = degrees(std::atan2(frame.x_axis[1], frame.x_axis[0])) + piece.angle_deg,
       .presence = presence});
}

/// What has been put is on the map, if anybody has been there to map it. Since then some pieces have been
/// moved or taken away, and perhaps one has come.
void add_with_changes(Layout& layout, bool is_mapped, World& world) {
  Rng& rng = layout.rng();
  const Frame& frame = layout.area().frame;
  const std::vector<Piece> mapped = layout.pieces();
  for (const Piece& piece : mapped) {
    const double moved_share = piece.kind == Kind::chair ? moved_chairs : moved;
    const double u = piece.kind == Kind::built ? 1.0 : rng.uniform();
    add_to_world(piece, frame, {is_mapped, u >= moved_share + removed}, world);
    if (u < moved_share) layout.put_beside(piece);
  }
  if (rng.uniform() < additions) layout.put_anywhere({.centre = {}, .size = {0.6, 0.5}});
  for (std::size_t i = mapped.size(); i < layout.pieces().size(); ++i)
    add_to_world(layout.pieces()[i], frame, {false, true}, world);
}

Area area_of(const Room& room, const OfficePlan& plan) {
  Area area{.frame = room.frame, .size = {room.width, room.depth}};
  const double left = std::min(room.frame.origin[0], room.frame.at(room.width, 0.0)[0]);
  constexpr double half_pillar = pillar_side / 2.0;
  for (auto pillar = std::lower_bound(plan.pillars.begin(), plan.pillars.end(), left - half_pillar);
       pillar != plan.pillars.end() && *pillar < left + room.width + half_pillar; ++pillar) {
    const double x = (*pillar - room.frame.origin[0]) * room.frame.x_axis[0];
    area.keep_free.push_back(
        between_corners({x - half_pillar, room.depth - half_pillar}, {x + half_pillar, room.depth}));
  }
  constexpr double half = door_width / 2.0;
  constexpr double leaf_turn = 0.2;  // m that an open door reaches to the side
  if (room.state != Door::none) {
    area.keep_free.push_back(
        between_corners({room.door - half - leaf_turn, 0.0}, {room.door + half, door_width}));
  }
  if (const double way_in = room.way_in(); way_in > 0.0) {
    area.keep_free.push_back(
        between_corners({room.door - lane_half, 0.0}, {room.door + lane_half, way_in + lane_half}));
  }
  return area;
}

void furnish_room(const Room& room, const OfficePlan& plan, const Rng& usual, const Rng& own, World& world) {
  const auto centimetres = [](double metres) {
    return static_cast<std::uint64_t>(std::lround(100.0 * metres));
  };
  Area area = area_of(room, plan);
  const std::vector<Piece> furniture = usual_furniture(
      area, room.use,
      usual.stream({static_cast<std::uint64_t>(room.use), static_cast<std::uint64_t>(room.style),
                    centimetres(room.width), centimetres(room.depth)}));
  Layout layout(std::move(area), own);
  if (layout.rng().uniform() < shafts) layout.put_shaft();
  for (const Piece& piece : furniture) put_usual(piece, layout);
  put_own(layout);
  add_with_changes(layout, room.state != Door::shut && room.state != Door::opened_since, world);
}

/// Cabinets and the like along both walls of a part of a corridor.
void furnish_corridor(Area area, const Rng& own, World& world) {
  constexpr double metres_a_piece = 5.0;
  constexpr double deepest = 0.45;
  area.sides_with_walls = 2;
  const double middle = area.size[1] / 2.0;
  const double half = lane_offset + lane_half;
  area.keep_free.push_back(between_corners({0.0, middle - half}, {area.size[0], middle + half}));
  const double depth = std::min(deepest, middle - half - margin - 2.0 * furniture_gap);
  Layout layout(std::move(area), own);
  const double pieces = layout.rng().uniform(0.0, 2.0 * layout.area().size[0] / metres_a_piece);
  put_cabinets(static_cast<int>(pieces), depth, layout);
  add_with_changes(layout, true, world);
}

/// What stood before a door or in a niche's opening would be in the way.
void keep_front_free(const Room& room, Area& corridor) {
  const double half = room.state == Door::none ? room.width / 2.0 : door_width / 2.0 + 0.1;
  const Position door = room.frame.at(room.door, 0.0);
  const double x = door[0] - corridor.frame.origin[0];
  const double y = door[1] - corridor.frame.origin[1];
  corridor.keep_free.push_back(between_corners({x - half, y}, {x + half, corridor.size[1] / 2.0}));
}

void furnish_corridors(const OfficePlan& plan, const Rng& rng, World& world) {
  std::vector<Area> areas;
  for (const Span& y : plan.corridors) {
    for (const Span& x : plan.wings)
      areas.push_back({.frame = {.origin = {x.from, y.from}}, .size = {x.length(), y.length()}});
  }
  for (const Room& room : plan.rooms)
    keep_front_free(room, areas[room.corridor * plan.wings.size() + room.wing]);
  for (std::size_t i = 0; i < areas.size(); ++i)
    furnish_corridor(std::move(areas[i]), rng.stream({i}), world);
}

void furnish_cross_corridors(const OfficePlan& plan, const Rng& rng, World& world) {
  for (std::size_t row = 0; row < plan.rows.size(); ++row) {
    for (std::size_t cross = 0; cross < plan.cross_corridors.size(); ++cross) {
      const Span& x = plan.cross_corridors[cross];
      const Span& y = plan.rows[row];
      const Frame frame{.origin = {x.to, y.from}, .x_axis = {0.0, 1.0}, .y_axis = {-1.0, 0.0}};
      furnish_corridor({.frame = frame, .size = {y.length(), x.length()}}, rng.stream({row, cross}), world);
    }
  }
}

}  // namespace

void furnish(const OfficePlan& plan, Rng rng, World& world) {
  const Rng usual = rng.stream({0});
  for (std::size_t i = 0; i < plan.rooms.size(); ++i)
    furnish_room(plan.rooms[i], plan, usual, rng.stream({1, i}), world);
  furnish_corridors(plan, rng.stream({2}), world);
  furnish_cross_corridors(plan, rng.stream({3}), world);
}

}  // namespace glocal::sites
