// All kinds of disturbances, and what is written down of their levels. Level 1 is a good robot on a bad day,
// level 3 is what makes people call, and at level 5 nobody would expect an answer. None was chosen by what a
// method makes of it.
#include <array>

#include "sources/disturbed/disturbance.hpp"
#include "sources/disturbed/drive_disturbances.hpp"
#include "sources/disturbed/range_disturbances.hpp"
#include "sources/disturbed/surroundings.hpp"

namespace glocal::disturbed {
namespace {

using Change = void(Readings&, double, Rng&);

/// Of kinds that change each scan by itself.
template <Change& change>
class OfEachScan final : public Disturbance {
 public:
  OfEachScan(double amount, Rng /*rng*/) : amount_(amount) {}
  std::optional<Sample> disturb(Sample sample, Rng rng) override {
    Readings readings(sample.observation.scan);
    change(readings, amount_, rng);
    sample.observation.scan = readings.scan();
    return sample;
  }

 private:
  double amount_;
};

template <class T>
std::unique_ptr<Disturbance> made(double amount, Rng rng) {
  return std::make_unique<T>(amount, rng);
}

constexpr std::array kinds = {
    // Readings.
    DisturbanceKind{{"noise",
                     "standard deviation of a range",
                     "m",
                     10.0,
                     {0.02, 0.04, 0.06, 0.09, 0.12},
                     "cheap lasers have 2 to 6 cm, and depth cameras 10 cm from 4 m on"},
                    made<OfEachScan<add_noise>>},
    DisturbanceKind{{"bias",
                     "by which ranges are too long",
                     "m",
                     10.0,
                     {0.05, 0.1, 0.2, 0.35, 0.5},
                     "dark and shiny surfaces give 5 cm; a wrong offset or another unit gives the rest"},
                    made<OfEachScan<add_bias>>},
    DisturbanceKind{{"stretch",
                     "share by which ranges are too long",
                     "",
                     1.0,
                     {0.01, 0.02, 0.03, 0.05, 0.1},
                     "a clock that is off gives 1 %, a plan of another scale 5 %"},
                    made<OfEachScan<stretch>>},
    DisturbanceKind{{"outliers",
                     "share of hits that are anything",
                     "",
                     1.0,
                     {0.05, 0.1, 0.15, 0.3, 0.45},
                     "sunlight and other lasers; beyond one half a scan says more wrong than right"},
                    made<OfEachScan<draw_outliers>>},
    DisturbanceKind{{"cross_talk",
                     "share of hits that are another sensor's, ten in a row",
                     "",
                     1.0,
                     {0.05, 0.1, 0.15, 0.3, 0.45},
                     "robots with the same lidar in one hall; levels as of outliers"},
                    made<OfEachScan<cross_talk>>},
    DisturbanceKind{{"dust",
                     "early readings in a metre",
                     "1/m",
                     10.0,
                     {0.005, 0.01, 0.02, 0.04, 0.08},
                     "dust, rain and fog: at level 5 one half of what is 9 m away is seen"},
                    made<OfEachScan<raise_dust>>},
    DisturbanceKind{{"mixed",
                     "share of edges with a reading between both sides",
                     "",
                     1.0,
                     {0.2, 0.4, 0.6, 0.8, 1.0},
                     "beams are wide: each sensor has some"},
                    made<OfEachScan<mix_at_edges>>},
    DisturbanceKind{{"dropped_beams",
                     "share of beams that are lost",
                     "",
                     0.999,
                     {0.1, 0.25, 0.5, 0.75, 0.9},
                     "black walls give nothing back"},
                    made<OfEachScan<drop_beams>>},
    DisturbanceKind{{"sparse",
                     "angle between beams",
                     "deg",
                     180.0,
                     {2.0, 5.0, 10.0, 15.0, 20.0},
                     "rings of sonars have 15 to 24 degrees"},
                    made<OfEachScan<thin_out>>},
    DisturbanceKind{{"fewer_rings",
                     "of a lidar's rings one in so many",
                     "",
                     1000.0,
                     {2.0, 3.0, 4.0, 8.0, 16.0},
                     "lidars have 128 to 8 rings, and planar lasers one"},
                    made<OfEachScan<thin_rings>>},
    DisturbanceKind{{"short_range",
                     "range of the sensor",
                     "m",
                     1000.0,
                     {12.0, 8.0, 5.0, 4.0, 3.0},
                     "cheap lasers see 8 to 12 m, depth cameras 3 to 5 m"},
                    made<OfEachScan<cut_range>>},
    DisturbanceKind{{"narrow",
                     "field of view",
                     "deg",
                     360.0,
                     {180.0, 120.0, 90.0, 60.0, 30.0},
                     "depth cameras have 60 to 90 degrees"},
                    made<OfEachScan<cut_view>>},
    // Surroundings.
    DisturbanceKind{{"companion",
                     "angle that somebody covers, 0.6 m before the sensor",
                     "deg",
                     360.0,
                     {20.0, 45.0, 90.0, 135.0, 180.0},
                     "a person covers 45 degrees, a cart 90 and more"},
                    made<OfEachScan<stand_before>>},
    DisturbanceKind{{"people",
                     "people who walk within 8 m",
                     "",
                     1000.0,
                     {2.0, 5.0, 10.0, 20.0, 40.0},
                     "40 within 8 m are a crowd: one on each 5 square metres"},
                    made<People>},
    DisturbanceKind{{"glass",
                     "share of places that are of glass",
                     "",
                     1.0,
                     {0.05, 0.1, 0.2, 0.3, 0.5},
                     "office fronts have a third"},
                    made<Glass>},
    DisturbanceKind{{"mirrors",
                     "share of places that mirror",
                     "",
                     1.0,
                     {0.02, 0.05, 0.1, 0.2, 0.4},
                     "lifts, shop windows and polished steel; in a hall of mirrors nobody finds the way"},
                    made<Mirrors>},
    // The drive.
    DisturbanceKind{{"dropped_scans",
                     "share of scans that are lost",
                     "",
                     0.999,
                     {0.1, 0.25, 0.5, 0.75, 0.9},
                     "a busy network"},
                    made<DroppedScans>},
    DisturbanceKind{{"late_scans",
                     "samples by which scans come too late",
                     "",
                     10000.0,
                     {1.0, 2.0, 5.0, 10.0, 15.0},
                     "clocks that nobody has set"},
                    made<LateScans>},
    DisturbanceKind{{"repeated_scans",
                     "samples with one and the same scan",
                     "",
                     1e6,
                     {2.0, 3.0, 5.0, 10.0, 1e6},
                     "a driver that hangs, at level 5 for ever"},
                    made<RepeatedScans>},
    DisturbanceKind{{"mount_angle",
                     "by which the sensor looks too far to the left",
                     "deg",
                     180.0,
                     {1.0, 2.0, 5.0, 10.0, 15.0},
                     "1 degree is a good mount, 15 are a wrong file"},
                    made<MountAngle>},
    DisturbanceKind{{"upside_down",
                     "1: the sensor hangs upside down",
                     "",
                     1.0,
                     {1.0, 1.0, 1.0, 1.0, 1.0},
                     "it does or it does not"},
                    made<UpsideDown>},
    DisturbanceKind{{"stretched_ways",
                     "share by which odometry's ways are too long",
                     "",
                     10.0,
                     {0.02, 0.05, 0.1, 0.2, 0.4},
                     "worn wheels give 2 %, other wheels 20 %"},
                    made<StretchedWays>},
    DisturbanceKind{{"pulled_aside",
                     "turn that odometry does not notice",
                     "deg/m",
                     180.0,
                     {0.5, 1.0, 2.0, 5.0, 10.0},
                     "one wheel 1 % larger than the other gives 1 degree"},
                    made<PulledAside>},
    DisturbanceKind{{"spinning_wheels",
                     "share of samples in which wheels spin",
                     "",
                     1.0,
                     {0.05, 0.1, 0.2, 0.35, 0.5},
                     "wet floors, and carpets"},
                    made<SpinningWheels>},
    DisturbanceKind{{"reversed_motions",
                     "share of samples in which odometry counts backwards",
                     "",
                     1.0,
                     {0.01, 0.02, 0.05, 0.1, 0.2},
                     "an encoder with a loose wire; one sample in five is a broken robot"},
                    made<ReversedMotions>},
    DisturbanceKind{{"jitter",
                     "samples by which odometry is older than its scan, at most",
                     "",
                     1.0,
                     {0.1, 0.25, 0.5, 0.75, 1.0},
                     "two drivers stamp what they read by their own clocks"},
                    made<Jitter>},
    DisturbanceKind{{"lost_motions",
                     "share of samples in which odometry stands still",
                     "",
                     1.0,
                     {0.05, 0.1, 0.2, 0.5, 1.0},
                     "at level 5 there is no odometry"},
                    made<LostMotions>},
};

}  // namespace

std::span<const DisturbanceKind> disturbance_kinds() {
  return kinds;
}

}  // namespace glocal::disturbed
