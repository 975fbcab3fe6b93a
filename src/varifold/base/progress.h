// Long jobs report how far they are and can be cancelled.
#pragma once

#include <functional>
#include <string_view>

namespace varifold {

/// Called now and then from the thread that called the job, with the name of the stage and the
/// part of it that is done, in [0, 1]. Returning false cancels the job (ErrorKind::kCancelled).
using Progress = std::function<bool(std::string_view stage, float done)>;

/// True when the job shall go on. An empty callback never cancels.
[[nodiscard]] inline bool report(const Progress& progress, std::string_view stage, float done) {
  return !progress || progress(stage, done);
}

}  // namespace varifold
