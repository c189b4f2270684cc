// What goes wrong around the robot: things that stay where they are, or walk about.
#pragma once

#include <vector>

#include "sources/disturbed/disturbance.hpp"
#include "sources/disturbed/readings.hpp"

namespace glocal::disturbed {

/// This share of all places, squares of 1 m that stay where they are, does something to rays that end there.
class Panes : public Disturbance {
 public:
  Panes(double share, Rng rng) : share_(share), rng_(rng) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) final;

 private:
  /// What becomes of one of these rays, of a scan that was `before`. `of_pane` is the same whenever a pane is
  /// met.
  virtual void change(Reading& reading, const Readings& before, Rng of_pane) const = 0;

  double share_;
  Rng rng_;
};

/// What the laser meets at glass is behind it: 0.5 to 3 m farther away, always the same at one place, or
/// nothing.
class Glass final : public Panes {
 public:
  using Panes::Panes;

 private:
  void change(Reading& reading, const Readings& before, Rng of_pane) const override;
};

/// What the laser meets at a mirror is what it would meet from there on, as a ball that bounces off the wall:
/// as far behind the wall as that is before it, or nothing. Walls stand upright, and what is around them is
/// what the scan itself shows.
class Mirrors final : public Panes {
 public:
  using Panes::Panes;

 private:
  void change(Reading& reading, const Readings& before, Rng of_pane) const override;
};

/// So many people walk within 8 m of the robot, and stand before what the sensor would meet.
class People final : public Disturbance {
 public:
  People(double people, Rng rng);
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  std::vector<Pose2> odom_from_people_;  ///< Each walks along his x axis.
  bool are_placed_ = false;
};

}  // namespace glocal::disturbed
