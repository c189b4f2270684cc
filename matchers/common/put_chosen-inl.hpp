// Included by files that Highway compiles once for each instruction set, after its own header.

#if defined(GLOCAL_MATCHERS_PUT_CHOSEN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOCAL_MATCHERS_PUT_CHOSEN_INL
#undef GLOCAL_MATCHERS_PUT_CHOSEN_INL
#else
#define GLOCAL_MATCHERS_PUT_CHOSEN_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {

/// Stores those values of a vector that are chosen, one behind the other, and returns how many they are.
/// Writes a whole vector: hwy::CompressStore writes no more than it must, for which AMD's Zen 4 takes some
/// seventy cycles. For values of four bytes: of eight, it is no faster (Highway 1.0, GCC 12).
template <class D, class V, class M>
HWY_INLINE std::size_t put_chosen(D d, V values, M chosen, hwy::HWY_NAMESPACE::TFromD<D>* to) {
  namespace hn = hwy::HWY_NAMESPACE;
  hn::StoreU(hn::Compress(values, chosen), d, to);
  return hn::CountTrue(d, chosen);
}

}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
