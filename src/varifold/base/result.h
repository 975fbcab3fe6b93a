// Bad outside data is a value, not an exception: every function that can fail on data it does not
// control returns Result<T>.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace varifold {

enum class ErrorKind {
  kInvalidInput,  ///< the data is malformed, truncated or inconsistent
  kUnsupported,   ///< the data is well-formed but asks for something that is not implemented
  kUnreadable,    ///< the file cannot be opened or read
  kFailed,        ///< the job itself failed: disk full, no OpenGL device, nothing to do
  kCancelled,     ///< the progress callback asked to stop
};

/// One clear line for a person: the place (file, line or byte offset, element) and the fault.
struct Error {
  ErrorKind kind = ErrorKind::kFailed;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorKind kind, std::string message) {
  return tl::unexpected<Error>(Error{kind, std::move(message)});
}

/// Puts `prefix` (a file name, a chunk name) before the message of an error on its way up.
[[nodiscard]] inline tl::unexpected<Error> fail_in(const std::string& prefix, Error error) {
  error.message = prefix + ": " + error.message;
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace varifold
