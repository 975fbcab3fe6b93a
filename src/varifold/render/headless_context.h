// An OpenGL context without a window, for pictures on servers and in tests.
#pragma once

#include <varifold/base/result.h>
#include <memory>
#include <string>

namespace varifold {

struct HeadlessOptions {
  /// Never use a GPU: the same pictures on every machine with the same Mesa. The environment
  /// variable LIBGL_ALWAYS_SOFTWARE=1 has the same effect.
  bool software = false;
};

/// Owns an EGL context with OpenGL 4.5 core. Current on the thread that made it until
/// another context becomes current there; a context is used by one thread at a time.
///
/// Tries, in this order: the GPUs that EGL lists, Mesa's surfaceless platform (llvmpipe where there
/// is no GPU), the default display.
class HeadlessContext {
 public:
  /// kFailed, with what to install, where there is no EGL, no driver or no OpenGL 4.5.
  [[nodiscard]] static Result<HeadlessContext> create(const HeadlessOptions& options = {});

  HeadlessContext(HeadlessContext&&) noexcept;
  HeadlessContext& operator=(HeadlessContext&&) noexcept;
  ~HeadlessContext();

  /// Makes the context current on the calling thread; it must not be current on another one.
  [[nodiscard]] Result<void> make_current() const;

  /// What draws, e.g. "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  [[nodiscard]] const std::string& description() const;

 private:
  struct Impl;
  explicit HeadlessContext(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace varifold
