/// One process at a time fills a file: flock(2) on "<file>-lock" beside it, let go when the process ends, however it
/// ends.
#pragma once

#include <filesystem>

namespace glidelab::validate {

/// What is held for as long as a process writes a database. EnvironmentError where another one does, or where the
/// lock's file cannot be made.
class WriterLock {
 public:
  explicit WriterLock(const std::filesystem::path& database);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace glidelab::validate
