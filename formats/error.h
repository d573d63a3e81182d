// Errors are values: what went wrong, where, why, and what to do about it.
//
// Every fallible function of deltaz returns Result<T>. No exception leaves a deltaz library: those of GDAL,
// of the JSON parser and of the allocator are caught at the edge where the foreign code is called.
// Thread-safety: plain values.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "formats/issue_code.h"

namespace deltaz {

// What kind of failure it is. The tools turn the kind into their exit code (see exitCode).
enum class ErrorKind : std::uint8_t {
  kInvalid,       // content refused, damaged, or not a deltaz database
  kUsage,         // wrong or missing option, target exists
  kCannotAccess,  // cannot read, write or lock
  kNewerFormat,   // written by a newer version than this reader knows
  kInternal,      // our own mistake
};

// The exit code of a tool that ends with an error of this kind: 1, 2, 3, 4, 70.
int exitCode(ErrorKind kind);

struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  IssueCode code =
      IssueCode::kNone;  // the code dbcheck reports this failure under; kNone outside database content
  std::string what;      // "block 7 does not match its checksum"
  std::string where;     // "area.dz/terrain-000001.dzt, byte 4096"
  std::string why;       // "the bytes were changed after they were written"; may be empty
  std::string remedy;    // "restore the file or rebuild the database"; may be empty

  // "where: what: why. remedy", one line.
  std::string message() const;
};

Error invalidError(IssueCode code, std::string where, std::string what, std::string why = {},
                   std::string remedy = {});
Error usageError(std::string where, std::string what, std::string why = {}, std::string remedy = {});
Error accessError(std::string where, std::string what, std::string why = {}, std::string remedy = {});
Error newerFormatError(IssueCode code, std::string where, std::string what, std::string remedy = {});
Error internalError(std::string where, std::string what);

// Either a value or an Error. Asking for the one that is not there is a mistake of the caller (assert).
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  T& value() & {
    assert(ok());
    return *std::get_if<T>(&state_);
  }
  const T& value() const& {
    assert(ok());
    return *std::get_if<T>(&state_);
  }
  // By value, so that looping over a temporary's value is safe.
  T value() && {
    assert(ok());
    return std::move(*std::get_if<T>(&state_));
  }
  const Error& error() const {
    assert(!ok());
    return *std::get_if<Error>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

struct Success {};
using Status = Result<Success>;

// Returns the error of `expression` from the calling function if it failed.
#define DELTAZ_TRY(expression)                                                       \
  do {                                                                               \
    if (auto try_status = (expression); !try_status.ok()) return try_status.error(); \
  } while (false)

#define DELTAZ_CONCATENATE_INNER(a, b) a##b
#define DELTAZ_CONCATENATE(a, b) DELTAZ_CONCATENATE_INNER(a, b)
// NOLINTBEGIN(bugprone-macro-parentheses): a declaration cannot stand in parentheses.
// Declares `declaration` with the value of `expression`, or returns its error from the calling function.
#define DELTAZ_TRY_ASSIGN(declaration, expression)               \
  auto DELTAZ_CONCATENATE(try_result_, __LINE__) = (expression); \
  if (!DELTAZ_CONCATENATE(try_result_, __LINE__).ok())           \
    return DELTAZ_CONCATENATE(try_result_, __LINE__).error();    \
  declaration = std::move(DELTAZ_CONCATENATE(try_result_, __LINE__)).value()
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace deltaz
