// What set-up code throws. The command line turns these into one line and an exit status.
#pragma once

#include <stdexcept>
#include <string>

namespace toile {

/// The work failed (exit status 1). The text names what, where and what to do, in one line.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The command was used wrongly (exit status 2).
class UsageError : public Error {
  public:
    using Error::Error;
};

/// A file cannot be used: reads "FILE: WHAT".
class FileError : public Error {
  public:
    FileError(const std::string& file, const std::string& what) : Error(file + ": " + what) {}
};

} // namespace toile
