// How fast recordings of robots are read, beside the bare decompressor. 64 MB of scans in chunks of 1 MB.
#include <benchmark/benchmark.h>
#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/rng.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bench {
namespace {

using namespace test::bags;

constexpr std::size_t chunks = 64;
constexpr std::size_t chunk_bytes = 1'000'000;

/// Scans of 1,081 beams along walls, with a noise of 1 cm: what a laser of today sends.
std::string scan(const std::string& encoding, std::size_t number) {
  Rng rng = Rng(1).stream({number});
  Writer writer(encoding);
  writer.header("laser", static_cast<std::int64_t>(number) * 25'000'000);
  for (const float v : {-2.356F, 2.356F, 0.00436F, 0.0F, 0.025F, 0.06F, 30.0F}) writer.number(v);
  constexpr std::uint32_t beams = 1081;
  writer.number(beams);
  for (std::uint32_t i = 0; i < beams; ++i) {
    const double range =
        4.0 + 2.0 * std::sin(0.01 * i + 0.02 * static_cast<double>(number)) + rng.normal(0.01);
    writer.number(static_cast<float>(std::round(1000.0 * range) / 1000.0));
  }
  return writer.number<std::uint32_t>(0).bytes();
}

/// The records of each chunk, unpacked.
std::vector<std::string> records_of(const std::string& encoding) {
  std::vector<std::string> all(chunks);
  std::size_t number = 0;
  for (std::string& records : all) {
    while (records.size() < chunk_bytes) {
      const std::string message = scan(encoding, number);
      records += encoding == "cdr" ? mcap_message(1, 25'000'000 * number, message)
                                   : ros1_message(1, static_cast<std::uint32_t>(number), message);
      ++number;
    }
  }
  return all;
}

std::string file_of(const std::string& encoding, const std::string& compression) {
  std::string bytes;
  std::uint64_t stamp = 0;
  for (const std::string& records : records_of(encoding)) {
    bytes += encoding == "cdr" ? mcap_chunk({stamp, stamp, records, compression})
                               : ros1_chunk(records, compression.empty() ? "none" : compression);
    ++stamp;
  }
  const std::string type = "sensor_msgs/LaserScan";
  return encoding == "cdr" ? mcap_file(mcap_channel(1, "/scan", type) + bytes)
                           : ros1_magic + ros1_bag_header() + ros1_connection(1, "/scan", type) + bytes;
}

void set_rate(benchmark::State& state) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * chunks * chunk_bytes);
}

/// Every message of a file, decoded if `decodes`.
void read(benchmark::State& state, const std::string& encoding, const std::string& compression,
          bool decodes) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("glocal_bench_" + std::to_string(std::rand()));
  std::ofstream(file, std::ios::binary) << file_of(encoding, compression);
  std::size_t seen = 0;
  for ([[maybe_unused]] auto _ : state) {
    bags::Recording recording(file);
    while (const auto message = recording.next())
      seen += decodes ? bags::read_laser_scan(*message).ranges.size() : message->bytes.size();
  }
  benchmark::DoNotOptimize(seen);
  set_rate(state);
  std::filesystem::remove(file);
}

void unpack(const std::string& compression, const std::string& packed, std::string& bytes) {
  if (compression == "zstd") {
    ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  } else if (compression == "bz2") {
    auto size = static_cast<unsigned>(bytes.size());
    std::string in = packed;
    BZ2_bzBuffToBuffDecompress(bytes.data(), &size, in.data(), static_cast<unsigned>(in.size()), 0, 0);
  } else {
    LZ4F_dctx* context = nullptr;
    LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
    std::size_t to = bytes.size(), from = packed.size();
    LZ4F_decompress(context, bytes.data(), &to, packed.data(), &from, nullptr);
    LZ4F_freeDecompressionContext(context);
  }
}

/// The same chunks, in memory, unpacked one by one.
void unpack_all(benchmark::State& state, const std::string& encoding, const std::string& compression) {
  std::vector<std::string> packed_chunks;
  for (const std::string& records : records_of(encoding))
    packed_chunks.push_back(packed(compression, records));
  std::string bytes(2 * chunk_bytes, '\0');
  for ([[maybe_unused]] auto _ : state) {
    for (const std::string& chunk : packed_chunks) unpack(compression, chunk, bytes);
  }
  benchmark::DoNotOptimize(bytes);
  set_rate(state);
}

void register_all() {
  const auto add = [](const std::string& name, auto function, auto... arguments) {
    return benchmark::RegisterBenchmark(name.c_str(), function, arguments...)->Unit(benchmark::kMillisecond);
  };
  const std::string none;
  add("read/mcap", read, std::string("cdr"), none, false);
  add("decode/mcap", read, std::string("cdr"), none, true);
  add("read/ros1", read, std::string("ros1"), none, false);
  add("decode/ros1", read, std::string("ros1"), none, true);
  for (const std::string compression : {"lz4", "zstd"}) {
    add("read/mcap_" + compression, read, std::string("cdr"), compression, false);
    add("unpack/mcap_" + compression, unpack_all, std::string("cdr"), compression);
  }
  for (const std::string compression : {"lz4", "bz2"}) {
    add("read/ros1_" + compression, read, std::string("ros1"), compression, false);
    add("unpack/ros1_" + compression, unpack_all, std::string("ros1"), compression);
  }
}

}  // namespace
}  // namespace glocal::bench

int main(int argc, char** argv) {
  return glocal::bench::run_registered(argc, argv, glocal::bench::register_all);
}
