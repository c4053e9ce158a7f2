#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace nerf::kernels {

// While it exists, the calling thread treats denormal floats as zero. The decaying moments of
// rarely updated entries become denormal, where every operation costs a hundred cycles.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : saved_(_mm_getcsr()) {
    constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
#else
  FlushDenormals() = default;
#endif
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace nerf::kernels
