// "Is there a point of the map within epsilon?" (contact_B of eq. 4), for runs of points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/registry.hpp"

namespace glocal {

struct VoxelGrid;

/// Tells which points are within epsilon (m) of a point of the map. Immutable, to be shared by all threads.
/// Contract: all that is nearer than 0.8 epsilon is in contact, nothing that is farther than 1.2 epsilon.
/// `bitset` rounds to its voxels, by half their diagonal: it keeps 0.78 and 1.22 in space, and on planar maps
/// over 25 ha 0.65 and 1.35.
class ContactIndex {
 public:
  /// One number for each motion of a batch.
  using BatchColumn = std::array<std::uint32_t, MotionBatch::capacity>;

  virtual ~ContactIndex() = default;

  /// How many of the points [begin, begin + n) are in contact, once moved into the map's frame. Points far
  /// away and points that are not numbers are in contact with nothing.
  [[nodiscard]] virtual std::size_t count(const Points& points, std::size_t begin, std::size_t n,
                                          const Transform& map_from_points) const = 0;

  /// What count_while() found.
  struct Count {
    std::size_t in_contact = 0;  ///< Where it stopped early: only that it is less than asked for.
    std::size_t looked_at = 0;
  };
  /// Counts the points from `begin` on, a batch at a time and n at most, and stops after batch b if fewer
  /// than least[b] have been found in contact up to there. `least` has an entry for each batch, the last of
  /// which may be smaller.
  [[nodiscard]] virtual Count count_while(const Points& points, std::size_t begin, std::size_t n,
                                          std::size_t batch, std::span<const std::uint32_t> least,
                                          const Transform& map_from_points) const;

  /// For each of the first `size` motions, a number that count() of the `n` points from begins[i] on does not
  /// exceed: a cheap look that spares most wrong poses a closer one. `begins` and `at_most` have room for a
  /// whole batch. Without anything better, n.
  virtual void count_at_most(const Points& points, std::size_t n, const MotionBatch& motions,
                             std::size_t size, const BatchColumn& begins, BatchColumn& at_most) const;

  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;

  /// Share of all points in contact (Omega, eq. 4), in [0, 1]; 0 without any point.
  [[nodiscard]] double share(const Points& points, const Transform& map_from_points) const {
    if (points.empty()) return 0.0;
    return static_cast<double>(count(points, 0, points.size(), map_from_points)) /
           static_cast<double>(points.size());
  }
  /// The same after a motion in space: indexes themselves move points in the plane only.
  [[nodiscard]] double share(const Points& points, const Pose3& map_from_points) const {
    return share(moved(points, map_from_points), Transform(Pose2{}));
  }
};

/// What a contact index is made from.
struct ContactSetup {
  const Points* map_points = nullptr;  ///< Not empty; there only while the index is made.
  double epsilon = 0.0;                ///< m
  int threads = 1;                     ///< The index is the same for any number of them.
};

/// All contact indexes by name.
using ContactIndexes = Registry<ContactIndex, ContactSetup>;

/// The map's points dilated by epsilon, one bit per voxel of side epsilon / 4 (half a cell of a map whose
/// cells are as large as epsilon / 2): constant time. A planar map (all points of one height) has a single
/// layer, which takes in everything within epsilon of that height. A voxel is in contact if its centre is
/// within epsilon of a point, so an answer can differ from the exact one only where the distance is within
/// half a voxel's diagonal of epsilon (0.18 epsilon in the plane). In the plane voxels are twice as wide on
/// maps of more than huge_area, where they would take more memory than all else. In space they come in bricks
/// of 32 x 8 x 8, and empty bricks take no memory.
class BitsetContact final : public ContactIndex {
 public:
  using Params = NoParams;

  /// Throws ConfigError if it would need more than 1 GiB.
  BitsetContact(const Points& points, double epsilon, int threads = 1);
  BitsetContact(const Params& /*params*/, const ContactSetup& setup)
      : BitsetContact(*setup.map_points, setup.epsilon, setup.threads) {}

  [[nodiscard]] std::size_t count(const Points& points, std::size_t begin, std::size_t n,
                                  const Transform& map_from_points) const override;
  [[nodiscard]] Count count_while(const Points& points, std::size_t begin, std::size_t n, std::size_t batch,
                                  std::span<const std::uint32_t> least,
                                  const Transform& map_from_points) const override;
  void count_at_most(const Points& points, std::size_t n, const MotionBatch& motions, std::size_t size,
                     const BatchColumn& begins, BatchColumn& at_most) const override;
  [[nodiscard]] std::size_t memory_bytes() const override {
    return (words_.size() + bricks_.size() + coarse_words_.size()) * sizeof(std::uint32_t);
  }

 private:
  void dilate(const Points& points, double epsilon, int threads);
  void dilate(const Point& p, double epsilon, int begin_row, int end_row);
  void set(std::size_t first_column, std::size_t last_column, std::size_t row, std::size_t layer);
  std::size_t place_bricks(const Points& points, double epsilon);
  [[nodiscard]] VoxelGrid grid() const;

  Point min_;                            ///< Outer corner of voxel (0, 0, 0).
  float scale_ = 0.0F, scale_z_ = 0.0F;  ///< Voxels per metre.
  std::size_t columns_ = 0, rows_ = 0, layers_ = 0;
  std::size_t brick_rows_ = 0;  ///< 0 where there are no bricks.
  std::size_t coarse_rows_ = 0;
  /// 32 voxels of a row in each; rows, then layers, of the whole grid in the plane and of each brick in
  /// space.
  std::vector<std::uint32_t> words_;
  /// In space, where each brick's words begin; rows, then layers. The first words are those of empty bricks.
  std::vector<std::uint32_t> bricks_;
  std::vector<std::uint32_t> coarse_words_;  ///< The same for 4 x 4 x 4 voxels joined: set if one of them is.
};

/// A kd-tree over the map's points: exact, and twenty-five times slower.
class KdTreeContact final : public ContactIndex {
 public:
  using Params = NoParams;

  KdTreeContact(const Points& points, double epsilon);
  KdTreeContact(const Params& /*params*/, const ContactSetup& setup)
      : KdTreeContact(*setup.map_points, setup.epsilon) {}
  ~KdTreeContact() override;

  [[nodiscard]] std::size_t count(const Points& points, std::size_t begin, std::size_t n,
                                  const Transform& map_from_points) const override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Adds the two above, as `bitset` and `kd_tree`.
void register_contact_indexes(ContactIndexes& indexes);

/// The contact index a strategy is to use: a parameter of it.
class ContactChoice {
 public:
  /// One of the two above.
  ContactChoice(const char* name = "bitset")  // NOLINT(google-explicit-constructor): reads as the name
      : choice_{name} {}
  /// Any of a catalog's, which must outlive the choice.
  explicit ContactChoice(const ContactIndexes& indexes) : choice_{"bitset"}, indexes_(&indexes) {}

  /// The field `name` of the strategy that has this parameter.
  void describe_as(const char* name, ParamVisitor& v);

 private:
  friend std::shared_ptr<const ContactIndex> contact_index(const GlobalMap&, const ContactChoice&, double,
                                                           int);

  StrategyChoice choice_;
  const ContactIndexes* indexes_ = nullptr;  ///< Null: the two above.
};

/// The field `contact_epsilon` of a stage that may have one of its own: m, or auto for that of the localizer
/// (StageSetup::epsilon()).
void describe_contact_epsilon(ParamVisitor& v, std::optional<double>& epsilon);

/// The chosen index over a map for an epsilon (m), built once per map. Throws ConfigError if it does not fit
/// into memory, std::out_of_range for an unknown name.
[[nodiscard]] std::shared_ptr<const ContactIndex> contact_index(const GlobalMap& map,
                                                                const ContactChoice& choice, double epsilon,
                                                                int threads = 1);

}  // namespace glocal
