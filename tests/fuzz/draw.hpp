// Files that are valid to the last checksum, and whose contents are whatever the input says: a byte chooses
// between what is plausible, what is extreme, and any bits at all.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace glocal::fuzz {

class Draw {
 public:
  Draw(const std::uint8_t* data, std::size_t size) : rest_(reinterpret_cast<const char*>(data), size) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  /// 0 behind the end.
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const auto first = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return first;
  }
  /// Of 0 to n - 1.
  std::size_t one_of(std::size_t n) { return byte() % n; }

  /// Mostly `plausible`, which is all that there is behind the end of the input.
  template <class T>
  T number(T plausible) {
    const std::uint8_t choice = byte();
    if (choice < first_extreme) return plausible;
    if (choice < first_bits) return extreme<T>(choice);
    std::array<char, sizeof(T)> bits{};
    for (char& c : bits) c = static_cast<char>(byte());
    T value;
    std::memcpy(&value, bits.data(), sizeof(T));
    return value;
  }
  /// The same as YAML and other texts have it.
  std::string digits(double plausible) {
    constexpr std::array<const char*, 16> texts = {"nan",
                                                   "-nan",
                                                   ".inf",
                                                   "-.inf",
                                                   "0",
                                                   "-0.0",
                                                   "1e-320",
                                                   "1e30",
                                                   "-1e30",
                                                   "1e-30",
                                                   "9223372036854775807",
                                                   "-9223372036854775808",
                                                   "1e400",
                                                   "18446744073709551616",
                                                   "0x10",
                                                   "-1"};
    const std::uint8_t choice = byte();
    if (choice < first_extreme) return std::to_string(plausible);
    if (choice < first_bits) return texts.at(choice % texts.size());
    return std::to_string(number(plausible));
  }
  std::string name(const std::string& plausible) {
    const std::uint8_t choice = byte();
    if (choice < first_bits) return plausible;
    switch (choice % 6) {
      case 0:
        return "";
      case 1:
        return "\033[31m" + plausible;
      case 2:
        return std::string(1U << (choice % 16), 'n');
      case 3:
        return plausible + '\0';
      case 4:
        return "/" + plausible;
      default:
        return std::string(1, static_cast<char>(byte())) + plausible;
    }
  }

 private:
  static constexpr std::uint8_t first_extreme = 0xC0, first_bits = 0xE8;

  template <class T>
  static T extreme(std::uint8_t choice) {
    using Limits = std::numeric_limits<T>;
    if constexpr (std::is_floating_point_v<T>) {
      constexpr std::array<T, 14> values = {T{0},
                                            -T{0},
                                            T{-1},
                                            Limits::quiet_NaN(),
                                            Limits::infinity(),
                                            -Limits::infinity(),
                                            Limits::denorm_min(),
                                            Limits::max(),
                                            Limits::lowest(),
                                            static_cast<T>(1e30),
                                            static_cast<T>(-1e30),
                                            static_cast<T>(1e-30),
                                            static_cast<T>(1e7),
                                            static_cast<T>(5e5)};
      return values.at(choice % values.size());
    } else {
      constexpr std::array<T, 6> values = {
          T{0}, static_cast<T>(-1), Limits::max(), Limits::min(), static_cast<T>(Limits::max() / 2), T{1}};
      return values.at(choice % values.size());
    }
  }

  std::string_view rest_;
};

}  // namespace glocal::fuzz
