#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sources/sites/office_plan.hpp"

namespace glocal::sites {
namespace {

using simulation::distance;
using simulation::Position;

constexpr double visited = 0.12;  // share of the rooms on the way that the robot drives into

/// Where a corridor and a cross corridor meet.
struct Crossing {
  std::size_t corridor = 0;
  std::size_t cross = 0;

  friend bool operator==(const Crossing&, const Crossing&) = default;
};

class Tour {
 public:
  Tour(const OfficePlan& plan, Rng rng) : plan_(plan), rng_(rng), open_rooms_(plan.corridors.size()) {
    for (const Room& room : plan.rooms) {
      if (room.way_in() > 0.0) open_rooms_[room.corridor].push_back(&room);
    }
    for (std::vector<const Room*>& rooms : open_rooms_)
      std::ranges::sort(rooms, {}, [](const Room* room) { return door(*room); });
    at_ = drawn_crossing();
    go(place(at_));
  }

  std::vector<Position> drive(double length) {
    while (length_ < length) {
      const Crossing target = drawn_target();
      while (at_ != target) go_towards(target);
      if (at_.cross == 0) visit_end(0);
      if (at_.cross + 1 == plan_.cross_corridors.size()) visit_end(at_.cross + 1);
    }
    end_after(length);
    return way_points_;
  }

 private:
  static double door(const Room& room) { return room.frame.at(room.door, 0.0)[0]; }

  Crossing drawn_crossing() {
    return {rng_.below(static_cast<std::uint32_t>(plan_.corridors.size())),
            rng_.below(static_cast<std::uint32_t>(plan_.cross_corridors.size()))};
  }

  /// Of some crossings the one that is farthest from where the robot has been.
  Crossing drawn_target() {
    constexpr int draws = 8;
    Crossing best;
    double farthest = -1.0;
    for (int i = 0; i < draws; ++i) {
      const Crossing crossing = drawn_crossing();
      double nearest = distance(place(crossing), way_points_.front());
      for (const Position& p : way_points_) nearest = std::min(nearest, distance(place(crossing), p));
      if (nearest <= farthest) continue;
      farthest = nearest;
      best = crossing;
    }
    return best;
  }

  [[nodiscard]] Position place(const Crossing& crossing) const {
    return {plan_.cross_corridors[crossing.cross].middle(), plan_.corridors[crossing.corridor].middle()};
  }

  void go(const Position& to) {
    if (!way_points_.empty()) length_ += distance(way_points_.back(), to);
    if (way_points_.empty() || way_points_.back() != to) way_points_.push_back(to);
  }

  /// Leaves out what is farther along the way.
  void end_after(double length) {
    for (double excess = length_ - length;;) {
      const Position last = way_points_.back();
      way_points_.pop_back();
      const double way = distance(way_points_.back(), last);
      if (way > excess) {
        way_points_.push_back(simulation::between(last, way_points_.back(), excess / way));
        return;
      }
      excess -= way;
    }
  }

  /// To the next crossing along one of the two corridors that lead nearer.
  void go_towards(const Crossing& target) {
    const bool is_on_corridor = at_.corridor == target.corridor;
    const bool goes_along = at_.cross != target.cross && (is_on_corridor || rng_.uniform() < 0.5);
    if (goes_along) {
      const bool goes_right = target.cross > at_.cross;
      visit_some(goes_right ? at_.cross + 1 : at_.cross, goes_right);
      goes_right ? ++at_.cross : --at_.cross;
    } else {
      target.corridor > at_.corridor ? ++at_.corridor : --at_.corridor;
    }
    go(place(at_));
  }

  /// Rooms of a wing along the present corridor.
  [[nodiscard]] std::vector<const Room*> open_rooms(std::size_t wing) const {
    std::vector<const Room*> rooms;
    for (const Room* room : open_rooms_[at_.corridor]) {
      if (room->wing == wing) rooms.push_back(room);
    }
    return rooms;
  }

  void visit_some(std::size_t wing, bool goes_right) {
    std::vector<const Room*> rooms = open_rooms(wing);
    if (!goes_right) std::ranges::reverse(rooms);
    const double lane = drawn_lane();
    for (const Room* room : rooms) {
      if (rng_.uniform() < visited) visit(*room, lane);
    }
  }

  /// A room of the first wing or the last, to which there is only one way.
  void visit_end(std::size_t wing) {
    const std::vector<const Room*> rooms = open_rooms(wing);
    if (rooms.empty()) return;
    visit(*rooms[rng_.below(static_cast<std::uint32_t>(rooms.size()))], drawn_lane());
    go(place(at_));
  }

  double drawn_lane() {
    return plan_.corridors[at_.corridor].middle() + rng_.uniform(-lane_offset, lane_offset);
  }

  void visit(const Room& room, double lane) {
    const Position before = {door(room), lane};
    go(before);
    go(room.frame.at(room.door, room.way_in()));
    go(before);
  }

  const OfficePlan& plan_;
  Rng rng_;
  std::vector<std::vector<const Room*>> open_rooms_;  ///< Of each corridor, from left to right.
  Crossing at_;
  double length_ = 0.0;
  std::vector<Position> way_points_;
};

}  // namespace

std::vector<Position> office_tour(const OfficePlan& plan, double length, Rng rng) {
  return Tour(plan, rng).drive(length);
}

}  // namespace glocal::sites
