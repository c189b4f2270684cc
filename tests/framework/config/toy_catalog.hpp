// Small strategies that do nothing but have parameters of every type.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"

namespace glocal::test {

struct Wall {
  std::vector<double> from = {0.0, 0.0};
  double height = 2.5;
};
void describe(ParamVisitor& v, Wall& p);

struct Noise {
  double range = 0.01;
  int beams = 8;
};
void describe(ParamVisitor& v, Noise& p);

struct ToyMap final : MapSource {
  struct Params {
    FilePath path;
    std::vector<std::array<double, 2>> segments = {{0.0, 1.0}};
    double resolution = 0.05;
    std::vector<Wall> walls;
  };
  explicit ToyMap(const Params& params);
  [[nodiscard]] MapData load() override;
};
void describe(ParamVisitor& v, ToyMap::Params& p);

/// A source with a source of its own, and every other type of field.
struct ToyDrive final : ObservationSource {
  struct Params {
    double min_range = 0.1;
    double max_range = 20.0;
    std::string label = "plain";
    std::string mode = "fast";
    bool loop = false;
    std::uint64_t salt = 7;
    std::vector<std::string> tags = {"a"};
    std::vector<FilePath> extras;
    FilePath optional_file;
    Noise noise;
  };
  explicit ToyDrive(const Params& params);
  [[nodiscard]] std::optional<Sample> next() override;
};
void describe(ParamVisitor& v, ToyDrive::Params& p);

/// What `ransam` is called in files; `indexed` has no parameters at all.
struct ToyMatcher final : Matcher {
  struct Params {
    int iterations = 200000;
    double contact_epsilon = 0.1;
    std::optional<double> patience = {};
  };
  explicit ToyMatcher(const Params& params);
  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override;
};
void describe(ParamVisitor& v, ToyMatcher::Params& p);

struct Nothing {};
void describe(ParamVisitor& v, Nothing& p);

struct ToyRater final : Rater {
  using Params = Nothing;
  explicit ToyRater(const Params& /*params*/) {}
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                         const std::vector<Hypothesis>& hypotheses) override;
};

/// Registers the above, and something without parameters for every stage under its default name.
void register_toys(Catalog& catalog);

}  // namespace glocal::test
