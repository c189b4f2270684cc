// glocal: finds out where a mobile robot is on a known map from range scans and odometry.
#include <CLI/CLI.hpp>

#include "clustering/register.hpp"
#include "commands.hpp"
#include "local_mappers/register.hpp"
#include "matchers/register.hpp"
#include "raters/register.hpp"
#include "sources/register.hpp"

namespace {

void register_all(glocal::Catalog& catalog) {
  glocal::register_sources(catalog);
  glocal::register_local_mappers(catalog);
  glocal::register_matchers(catalog);
  glocal::register_clustering(catalog);
  glocal::register_raters(catalog);
}

}  // namespace

int main(int argc, char** argv) {
  glocal::app::Context context;
  register_all(context.catalog);
  CLI::App app("Finds out where a mobile robot is on a known map from range scans and odometry.", "glocal");
  glocal::app::add_run(app, context);
  glocal::app::add_simulate(app, context);
  glocal::app::add_map(app, context);
  glocal::app::add_mapping(app, context);
  CLI11_PARSE(app, argc, argv);
  return context.exit_code;
}
