// main() of the programs that register their benchmarks when they start.
#include "bench/scenes.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RegisterBenchmark("reference_loop", glocal::bench::reference_loop)
      ->Unit(benchmark::kMillisecond);
  glocal::bench::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
