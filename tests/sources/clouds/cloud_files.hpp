// Hand-made files of clouds.
#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace glocal::test {

/// The bytes of numbers, each of the type that is given, in the order of this machine.
template <class... T>
[[nodiscard]] std::string bytes(T... numbers) {
  std::string all;
  const auto append = [&](const auto& number) {
    std::array<char, sizeof(number)> own{};
    std::copy_n(reinterpret_cast<const char*>(&number), sizeof(number), own.begin());
    all.append(own.data(), own.size());
  };
  (append(numbers), ...);
  return all;
}

/// The same in the other order.
template <class... T>
[[nodiscard]] std::string swapped_bytes(T... numbers) {
  std::string all;
  const auto append = [&](const auto& number) {
    std::string one = bytes(number);
    std::reverse(one.begin(), one.end());
    all += one;
  };
  (append(numbers), ...);
  return all;
}

/// Data that LZF takes for compressed: all of it as it is.
[[nodiscard]] inline std::string stored_as_lzf(const std::string& data) {
  constexpr std::size_t longest = 32;
  std::string out;
  for (std::size_t at = 0; at < data.size(); at += longest) {
    const std::string part = data.substr(at, longest);
    out += static_cast<char>(part.size() - 1);
    out += part;
  }
  return out;
}

}  // namespace glocal::test
