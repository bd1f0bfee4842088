#include "validate/study/database/writer_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "base/errors.h"

namespace glidelab::validate {

WriterLock::WriterLock(const std::filesystem::path& database) {
  const std::string name = database.string() + "-lock";
  file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) base::throw_system_error(name, "cannot be made", errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  ::close(file_);
  if (error == EWOULDBLOCK) {
    throw base::EnvironmentError(
        fmt::format("{}: another process is filling it; wait for it, or give another --out", database.string()));
  }
  base::throw_system_error(name, "cannot be locked", error);
}

WriterLock::~WriterLock() {
  ::close(file_);  // the file stays: to remove it would let two processes lock two files of one name
}

}  // namespace glidelab::validate
