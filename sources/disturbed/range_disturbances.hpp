// What goes wrong with single readings: each takes what the sensor measures.
#pragma once

#include "glocal/rng.hpp"
#include "sources/disturbed/readings.hpp"

namespace glocal::disturbed {

/// Each range has a normal error of `sigma` m.
void add_noise(Readings& readings, double sigma, Rng& rng);

/// Each range is `bias` m too long.
void add_bias(Readings& readings, double bias, Rng& rng);

/// Each range is 1 + `excess` times too long.
void stretch(Readings& readings, double excess, Rng& rng);

/// This share of the hits is anything between the sensor and the farthest ray.
void draw_outliers(Readings& readings, double share, Rng& rng);

/// This share of the hits is where another sensor's light arrives: ten rays in a row have one range between
/// the sensor and the farthest ray.
void cross_talk(Readings& readings, double share, Rng& rng);

/// Rays end early at what is in the air, `density` times in a metre.
void raise_dust(Readings& readings, double density, Rng& rng);

/// At this share of the edges, where one of two neighbours is more than 0.5 m behind the other, the farther
/// one is measured between both.
void mix_at_edges(Readings& readings, double share, Rng& rng);

/// This share of the hits is lost, and of the rays that meet nothing.
void drop_beams(Readings& readings, double share, Rng& rng);

/// Of rays nearer to each other than this, deg seen from above, the first is left, of each height in space.
void thin_out(Readings& readings, double step_deg, Rng& rng);

/// Of a lidar's rings, rays of one height to a degree, every `step`-th from below is left; of a planar scan
/// its only one.
void thin_rings(Readings& readings, double step, Rng& rng);

/// What is farther away than this, m, is not seen: the ray is free up to there.
void cut_range(Readings& readings, double range, Rng& rng);

/// Only rays within this angle, deg, with the robot's front in its middle, are left.
void cut_view(Readings& readings, double angle_deg, Rng& rng);

/// Rays within this angle, deg, with the robot's front in its middle, end at somebody 0.6 m away.
void stand_before(Readings& readings, double angle_deg, Rng& rng);

}  // namespace glocal::disturbed
