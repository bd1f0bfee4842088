/// A library that is loaded before all others (LD_PRELOAD) and makes one call of one function fail, the n-th, as the
/// system or the library would make it fail; all others go through. fail_each_call.py drives it.
///
///     GLIDELAB_FAIL=write:3         the third write() fails, with ENOSPC
///     GLIDELAB_FAIL_COUNTS=FILE     instead: how often each function was called, one "name count" a line
///
/// With GLIDELAB_FAIL_TRACE set, the stack of the call that fails is written to standard error. Only calls count that
/// the program `glidelab` makes itself while main() runs: what it starts is left alone, and so are libraries among
/// themselves.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <spawn.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}
#include <cvodes/cvodes.h>

namespace {

/// How often one function was called.
struct Calls {
  const char* name;
  long count = 0;
  Calls* next;
  explicit Calls(const char* of);
};
Calls* all_calls = nullptr;  // a list: this library must not allocate
Calls::Calls(const char* of) : name(of), next(all_calls) {
  all_calls = this;
}

bool is_running = false;  // main() of a process called `glidelab`

int (*program)(int, char**, char**) = nullptr;  // its main()

/// Whether the address lies in the program itself or in the standard library that works for it.
bool is_own(void* address) {
  static const void* const base = [] {
    Dl_info of{};
    return dladdr(reinterpret_cast<void*>(program), &of) != 0 ? of.dli_fbase : nullptr;
  }();
  Dl_info caller{};
  if (dladdr(address, &caller) == 0) return false;
  return caller.dli_fbase == base || std::strstr(caller.dli_fname, "libstdc++") != nullptr;
}

void write_trace() {
  if (std::getenv("GLIDELAB_FAIL_TRACE") == nullptr) return;
  void* stack[40];
  backtrace_symbols_fd(stack, backtrace(stack, 40), 2);
}

/// Whether this call, from `caller`, is the one that fails.
bool fails(Calls& calls, void* caller) {
  if (!is_running || !is_own(caller)) return false;
  const long now = __atomic_add_fetch(&calls.count, 1, __ATOMIC_RELAXED);
  static const char* const wanted = std::getenv("GLIDELAB_FAIL");
  if (wanted == nullptr) return false;
  const char* const colon = std::strchr(wanted, ':');
  const auto length = static_cast<std::size_t>(colon - wanted);
  if (std::strncmp(wanted, calls.name, length) != 0 || calls.name[length] != '\0' || std::atol(colon + 1) != now) {
    return false;
  }
  is_running = false;  // nothing else fails, and what is written below is not counted
  write_trace();
  return true;
}

void write_counts() {
  const char* const path = std::getenv("GLIDELAB_FAIL_COUNTS");
  if (path == nullptr) return;
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) return;
  for (const Calls* calls = all_calls; calls != nullptr; calls = calls->next) {
    std::fprintf(file, "%s %ld\n", calls->name, calls->count);
  }
  std::fclose(file);
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// As libav has it: the context that was given is freed.
int no_input(AVFormatContext** context) {
  avformat_free_context(*context);
  *context = nullptr;
  return AVERROR(EIO);
}

int no_space() {
  errno = ENOSPC;
  return -1;
}

}  // namespace

#define GLIDELAB_FAILING(type, name, parameters, arguments, failure) \
  extern "C" type name parameters {                                  \
    static Calls calls(#name);                                       \
    static const auto through = real<type(*) parameters>(#name);     \
    if (fails(calls, __builtin_return_address(0))) return failure;   \
    return through arguments;                                        \
  }

namespace {

int counted(int argc, char** argv, char** environment) {
  is_running = std::strcmp(program_invocation_short_name, "glidelab") == 0;
  const bool told = is_running;
  const int status = program(argc, argv, environment);
  is_running = false;
  if (told) write_counts();
  return status;
}
}  // namespace

extern "C" int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(),
                                 void (*fini)(), void (*loader_fini)(), void* stack_end) {
  program = main;
  return real<decltype(&__libc_start_main)>("__libc_start_main")(counted, argc, argv, init, fini, loader_fini,
                                                                 stack_end);
}

// The system. What fails has not been done, but for close(), which closes and says that something was lost.
extern "C" int open(const char* path, int flags, ...) {
  static Calls calls("open");
  static const auto through = real<int (*)(const char*, int, ...)>("open");
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return fails(calls, __builtin_return_address(0)) ? no_space() : through(path, flags, mode);
}
extern "C" std::FILE* fopen(const char* path, const char* mode) {
  static Calls calls("fopen");
  static const auto through = real<std::FILE* (*)(const char*, const char*)>("fopen");
  if (!fails(calls, __builtin_return_address(0))) return through(path, mode);
  errno = EMFILE;
  return nullptr;
}
extern "C" std::FILE* fopen64(const char* path, const char* mode) {
  static Calls calls("fopen64");
  static const auto through = real<std::FILE* (*)(const char*, const char*)>("fopen64");
  if (!fails(calls, __builtin_return_address(0))) return through(path, mode);
  errno = EMFILE;
  return nullptr;
}
extern "C" int close(int file) {
  static Calls calls("close");
  static const auto through = real<int (*)(int)>("close");
  const int status = through(file);
  return fails(calls, __builtin_return_address(0)) ? no_space() : status;
}
GLIDELAB_FAILING(ssize_t, write, (int file, const void* bytes, std::size_t count), (file, bytes, count), no_space())
GLIDELAB_FAILING(ssize_t, writev, (int file, const struct iovec* parts, int count), (file, parts, count), no_space())
GLIDELAB_FAILING(int, mkdir, (const char* path, mode_t mode) noexcept, (path, mode), no_space())
GLIDELAB_FAILING(int, rename, (const char* from, const char* to) noexcept, (from, to), no_space())
GLIDELAB_FAILING(int, renameat2, (int a, const char* from, int b, const char* to, unsigned flags) noexcept,
                 (a, from, b, to, flags), no_space())
GLIDELAB_FAILING(int, posix_spawnp,
                 (pid_t * pid, const char* file, const posix_spawn_file_actions_t* actions,
                  const posix_spawnattr_t* attributes, char* const* argv, char* const* envp),
                 (pid, file, actions, attributes, argv, envp), EAGAIN)

// Memory of C++.
void* operator new(std::size_t size) {
  static Calls calls("new");
  if (fails(calls, __builtin_return_address(0))) throw std::bad_alloc();
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

// Libraries.
GLIDELAB_FAILING(int, CVode, (void* memory, sunrealtype to, N_Vector y, sunrealtype* t, int task),
                 (memory, to, y, t, task), CV_CONV_FAILURE)
GLIDELAB_FAILING(void*, CVodeCreate, (int lmm, SUNContext context), (lmm, context), nullptr)
GLIDELAB_FAILING(int, CVodeInit, (void* memory, CVRhsFn f, sunrealtype t0, N_Vector y0), (memory, f, t0, y0),
                 CV_MEM_FAIL)
GLIDELAB_FAILING(int, CVodeReInit, (void* memory, sunrealtype t0, N_Vector y0), (memory, t0, y0), CV_NO_MALLOC)
GLIDELAB_FAILING(int, CVodeRootInit, (void* memory, int count, CVRootFn g), (memory, count, g), CV_MEM_FAIL)
GLIDELAB_FAILING(int, SUNContext_Create, (void* comm, SUNContext* context), (comm, context), -1)
GLIDELAB_FAILING(N_Vector, N_VNew_Serial, (sunindextype length, SUNContext context), (length, context), nullptr)
GLIDELAB_FAILING(SUNMatrix, SUNDenseMatrix, (sunindextype rows, sunindextype columns, SUNContext context),
                 (rows, columns, context), nullptr)
GLIDELAB_FAILING(int, sqlite3_open_v2, (const char* file, sqlite3** database, int flags, const char* vfs),
                 (file, database, flags, vfs), SQLITE_CANTOPEN)
GLIDELAB_FAILING(int, sqlite3_prepare_v2,
                 (sqlite3 * database, const char* sql, int bytes, sqlite3_stmt** statement, const char** tail),
                 (database, sql, bytes, statement, tail), SQLITE_NOMEM)
GLIDELAB_FAILING(int, sqlite3_step, (sqlite3_stmt * statement), (statement), SQLITE_FULL)
GLIDELAB_FAILING(int, sqlite3_exec,
                 (sqlite3 * database, const char* sql, int (*each)(void*, int, char**, char**), void* with,
                  char** message),
                 (database, sql, each, with, message), SQLITE_IOERR)
GLIDELAB_FAILING(int, sqlite3_bind_double, (sqlite3_stmt * statement, int at, double value), (statement, at, value),
                 SQLITE_NOMEM)
GLIDELAB_FAILING(int, avformat_open_input,
                 (AVFormatContext * *context, const char* url, const AVInputFormat* format, AVDictionary** options),
                 (context, url, format, options), no_input(context))
GLIDELAB_FAILING(int, avformat_find_stream_info, (AVFormatContext * context, AVDictionary** options),
                 (context, options), AVERROR(ENOMEM))
GLIDELAB_FAILING(AVFormatContext*, avformat_alloc_context, (), (), nullptr)
GLIDELAB_FAILING(int, av_read_frame, (AVFormatContext * context, AVPacket* packet), (context, packet), AVERROR(EIO))
GLIDELAB_FAILING(int, avcodec_open2, (AVCodecContext * context, const AVCodec* codec, AVDictionary** options),
                 (context, codec, options), AVERROR(ENOMEM))
GLIDELAB_FAILING(AVCodecContext*, avcodec_alloc_context3, (const AVCodec* codec), (codec), nullptr)
GLIDELAB_FAILING(int, avcodec_send_packet, (AVCodecContext * context, const AVPacket* packet), (context, packet),
                 AVERROR(ENOMEM))
GLIDELAB_FAILING(int, avcodec_receive_frame, (AVCodecContext * context, AVFrame* frame), (context, frame),
                 AVERROR(ENOMEM))
GLIDELAB_FAILING(int, avcodec_send_frame, (AVCodecContext * context, const AVFrame* frame), (context, frame),
                 AVERROR(ENOMEM))
GLIDELAB_FAILING(int, avcodec_receive_packet, (AVCodecContext * context, AVPacket* packet), (context, packet),
                 AVERROR(ENOMEM))
GLIDELAB_FAILING(AVFrame*, av_frame_alloc, (), (), nullptr)
GLIDELAB_FAILING(AVPacket*, av_packet_alloc, (), (), nullptr)
GLIDELAB_FAILING(int, av_frame_get_buffer, (AVFrame * frame, int align), (frame, align), AVERROR(ENOMEM))
GLIDELAB_FAILING(int, avio_open, (AVIOContext * *context, const char* url, int flags), (context, url, flags),
                 AVERROR(ENOSPC))
GLIDELAB_FAILING(int, avformat_write_header, (AVFormatContext * context, AVDictionary** options), (context, options),
                 AVERROR(ENOSPC))
GLIDELAB_FAILING(int, av_write_frame, (AVFormatContext * context, AVPacket* packet), (context, packet), AVERROR(ENOSPC))
GLIDELAB_FAILING(int, av_write_trailer, (AVFormatContext * context), (context), AVERROR(ENOSPC))
GLIDELAB_FAILING(SwsContext*, sws_getCachedContext,
                 (SwsContext * context, int from_w, int from_h, AVPixelFormat from, int to_w, int to_h,
                  AVPixelFormat to, int flags, SwsFilter* in, SwsFilter* out, const double* parameters),
                 (context, from_w, from_h, from, to_w, to_h, to, flags, in, out, parameters), nullptr)
