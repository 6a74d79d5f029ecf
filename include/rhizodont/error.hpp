// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

/// Why a function gave up; the value is the exit code of the command-line program.
enum class ErrorCode : int {
  wrong_usage = 2,     ///< the call itself is off: an unknown option, a value out of its range
  unusable_input = 3,  ///< the file or the mesh in it cannot be used
  no_result = 4,       ///< no result was found that keeps the promises
  internal = 5,        ///< a fault of the program
  partial = 6,         ///< of several teeth some have no result
  unwritable = 7,      ///< a result cannot be written where it should go
};

/// What the ids of an error are.
enum class ElementKind {
  other,  ///< of no mesh that the user gave: lines of a file, records, parts of what was in the making
  vertices,
  triangles,
  vertex_pairs,    ///< such as edges
  triangle_pairs,  ///< such as those that cut each other
};

/// Base of all exceptions that the library throws.
/// `what()` is one sentence that a dental technician understands; `elements()` are the ids concerned, possibly none,
/// and `kind()` says of what.
class RHIZODONT_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& sentence, std::vector<std::int64_t> elements = {},
        ElementKind kind = ElementKind::other)
      : std::runtime_error(sentence), code_(code), elements_(std::move(elements)), kind_(kind) {}

  ErrorCode code() const noexcept { return code_; }
  const std::vector<std::int64_t>& elements() const noexcept { return elements_; }
  ElementKind kind() const noexcept { return kind_; }

 private:
  ErrorCode code_;
  std::vector<std::int64_t> elements_;
  ElementKind kind_;
};

/// An option or argument is out of its range.
class RHIZODONT_EXPORT UsageError : public Error {
 public:
  explicit UsageError(const std::string& sentence) : Error(ErrorCode::wrong_usage, sentence) {}
};

/// The input cannot be used: unreadable, damaged, or not a crown.
class RHIZODONT_EXPORT InputError : public Error {
 public:
  explicit InputError(const std::string& sentence, std::vector<std::int64_t> elements = {},
                      ElementKind kind = ElementKind::other)
      : Error(ErrorCode::unusable_input, sentence, std::move(elements), kind) {}

  /// The same of the same elements, in other words.
  InputError reworded(const std::string& sentence) const { return InputError(sentence, elements(), kind()); }
};

/// A file cannot be written: no room, no right, no such place. What stood there before stands there still.
class RHIZODONT_EXPORT OutputError : public Error {
 public:
  explicit OutputError(const std::string& sentence) : Error(ErrorCode::unwritable, sentence) {}
};

/// The input was understood, but no result keeps the promises.
class RHIZODONT_EXPORT NoResultError : public Error {
 public:
  explicit NoResultError(const std::string& sentence, std::vector<std::int64_t> elements = {},
                         ElementKind kind = ElementKind::other)
      : Error(ErrorCode::no_result, sentence, std::move(elements), kind) {}
};

}  // namespace rhizodont
