// Preloaded into the program, it makes calls of the C library and of OpenCL fail, and a device
// smaller than it is. faults.py is its other half. Environment:
//
//   HEMI_FAIL=NAME:N[+]      the N-th call of NAME fails, with + all later ones, too
//   HEMI_FAIL_WITH=NUMBER    errno or OpenCL's error; "short": half is written, then the disk is
//   full HEMI_FAIL_IN=all         counts the calls of device drivers and their compilers, too
//   HEMI_NAMED=1             the file system knows no files without name
//   HEMI_CALLS=FILE          gets a line "NAME calls failed" of each function at the end
//   HEMI_TRACE=FILE          gets a line "NAME N WHAT" of each call for a file, which is WHAT, or
//                            for an argument of a kernel, "KERNEL INDEX"
//   HEMI_DEVICE=HEX=VALUE,.. answers of clGetDeviceInfo: a number, or a text
//
// OpenCL's functions and those of files take pointers and whole numbers only, a machine word each,
// so that ten words passed on are any call of theirs: so says the ABI of x86-64 and AArch64.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" void* __libc_malloc(std::size_t size);

namespace {

using Word = std::intptr_t;
using Call = Word (*)(Word, Word, Word, Word, Word, Word, Word, Word, Word, Word);

struct Function {
    const char* name;
    Word error;  // unless HEMI_FAIL_WITH says otherwise
    std::atomic<long> calls{0}, failed{0};
    Function* next = nullptr;
    std::atomic<void*> real{nullptr};
};

// Plain memory: allocations are counted before any constructor has run, and after all destructors.
struct Plan {
    bool known, all_callers, for_ever, is_short, has_error;
    char name[64];
    long number;
    Word error;
    int trace;  // descriptor, or less than 0
} g_plan;
std::atomic<Function*> g_functions{nullptr};

const char* set_to(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

// As the plain functions are our own, and would count.
int created(const char* path) {
    if (*path == 0) return -1;
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC;
    return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, kFlags, 0666));
}

void read_plan() {
    if (g_plan.known || environ == nullptr) return;
    const char* const fail = set_to("HEMI_FAIL");
    const char* const colon = std::strchr(fail, ':');
    if (colon != nullptr && colon - fail < 64) {
        std::memcpy(g_plan.name, fail, static_cast<std::size_t>(colon - fail));
        g_plan.number = std::atol(colon + 1);
        g_plan.for_ever = std::strchr(colon, '+') != nullptr;
    }
    const char* const with = set_to("HEMI_FAIL_WITH");
    g_plan.is_short = std::strcmp(with, "short") == 0;
    g_plan.has_error = *with != 0 && !g_plan.is_short;
    g_plan.error = std::atol(with);
    g_plan.all_callers = std::strcmp(set_to("HEMI_FAIL_IN"), "all") == 0;
    g_plan.trace = created(set_to("HEMI_TRACE"));
    g_plan.known = true;
}

bool is_of(const char* library, void* caller) {
    dl_find_object from;  // dladdr would look for the symbol, in LLVM for a millisecond
    return _dl_find_object(caller, &from) == 0 &&
           std::strstr(from.dlfo_link_map->l_name, library) != nullptr;
}

std::atomic<bool> g_started{false};

// What drivers and compilers call for themselves is theirs to handle, and what libraries do when
// they are loaded.
bool is_ours(void* caller) {
    if (!g_started) return false;
    for (const char* theirs : {"pocl", "OpenCL", "LLVM", "clang", "hwloc", "/libc.so", "/ld-"})
        if (is_of(theirs, caller)) return false;
    return true;
}

// Of the program's exit itself there is nobody to tell.
void note(Function& function) {
    Function* first = g_functions.load();
    do {
        function.next = first;
    } while (!g_functions.compare_exchange_weak(first, &function));
}

// What a call is for. Plain memory, as whoever asks may be asking for memory.
struct What {
    char text[256] = {};
};

bool is_traced() {
    read_plan();
    return g_plan.known && g_plan.trace >= 0;
}

What path(Word path) {
    What what;
    if (path != 0 && is_traced()) std::strncpy(what.text, reinterpret_cast<const char*>(path), 255);
    return what;
}

What file(Word descriptor) {
    What what;
    if (!is_traced()) return what;
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%ld", static_cast<long>(descriptor));
    if (syscall(SYS_readlink, link, what.text, 255) < 0) what.text[0] = 0;
    return what;
}

bool fails(Function& function, void* caller, const What* what = nullptr) {
    read_plan();
    if (!g_plan.known || !(g_plan.all_callers || is_ours(caller))) return false;
    const long call = ++function.calls;
    if (call == 1) note(function);
    if (what != nullptr && g_plan.trace >= 0)
        dprintf(g_plan.trace, "%s %ld %s\n", function.name, call, what->text);
    if (std::strcmp(g_plan.name, function.name) != 0) return false;
    const bool now = call == g_plan.number || (g_plan.for_ever && call > g_plan.number);
    if (now) ++function.failed;
    return now;
}

Word error_of(const Function& function) { return g_plan.has_error ? g_plan.error : function.error; }

// libOpenCL has its functions under versions, the first of which would do.
template <class Real = Call>
Real real(Function& function) {
    void* found = function.real.load();
    if (found == nullptr) function.real = found = dlsym(RTLD_NEXT, function.name);
    return reinterpret_cast<Real>(found);
}

Word fail_with_errno(const Function& function) {
    errno = static_cast<int>(error_of(function));
    return -1;
}

__attribute__((destructor)) void tell() {
    const int file = created(set_to("HEMI_CALLS"));
    if (file < 0) return;
    for (const Function* one = g_functions; one != nullptr; one = one->next)
        dprintf(file, "%s %ld %ld\n", one->name, one->calls.load(), one->failed.load());
}

// Whoever leaves at once runs no destructors.
extern "C" [[noreturn]] void leave_at_once(int status) asm("_exit");
extern "C" [[noreturn]] void leave_at_once(int status) {
    tell();
    syscall(SYS_exit_group, status);
    __builtin_unreachable();
}

// The answer of HEMI_DEVICE to the question `what`; null where it has none.
const char* device_answer(Word what) {
    for (const char* at = set_to("HEMI_DEVICE"); *at != 0; ++at) {
        char* value = nullptr;
        if (std::strtol(at, &value, 16) == what && *value == '=') return value + 1;
        at = std::strchr(at, ',');
        if (at == nullptr) return nullptr;
    }
    return nullptr;
}

bool is_text(Word what) { return what >= 0x102B && what <= 0x1030; }  // CL_DEVICE_NAME and on

// clGetDeviceInfo(device, what, size, value, size needed), answered by HEMI_DEVICE.
Word answer_for(Word what, const char* answer, Word size, void* value, std::size_t* needed) {
    char text[1024] = {};
    std::strncpy(text, answer, std::strcspn(answer, ",") < 1023 ? std::strcspn(answer, ",") : 1023);
    if (is_text(what)) {
        const std::size_t length = std::strlen(text) + 1;
        if (needed != nullptr) *needed = length;
        if (value != nullptr) std::memcpy(value, text, length);
        return 0;
    }
    const std::uint64_t number = std::strtoull(text, nullptr, 0);
    if (value != nullptr) std::memcpy(value, &number, static_cast<std::size_t>(size));
    return 0;
}

}  // namespace

#define WORDS Word a, Word b, Word c, Word d, Word e, Word f, Word g, Word h, Word i, Word j
#define PASSED_ON a, b, c, d, e, f, g, h, i, j
// Under a name of our own, as the headers' declarations have other arguments.
#define EXPORTED(name)                             \
    extern "C" Word fail_##name(WORDS) asm(#name); \
    extern "C" Word fail_##name(WORDS)
#define CALLER __builtin_return_address(0)

// The error is what the function returns, CL_OUT_OF_RESOURCES unless told otherwise.
#define FAILS_BY_STATUS(name)                                   \
    EXPORTED(name) {                                            \
        static Function function{#name, -5};                    \
        if (fails(function, CALLER)) return error_of(function); \
        return real(function)(PASSED_ON);                       \
    }

// It goes to where the argument of that letter points, CL_OUT_OF_RESOURCES; null is returned.
#define FAILS_BY_POINTER(name, argument)                                              \
    EXPORTED(name) {                                                                  \
        static Function function{#name, -5};                                          \
        if (!fails(function, CALLER)) return real(function)(PASSED_ON);               \
        if (argument != 0)                                                            \
            *reinterpret_cast<int*>(argument) = static_cast<int>(error_of(function)); \
        return 0;                                                                     \
    }

// `what` is path(ARGUMENT) or file(ARGUMENT).
#define FAILS_BY_ERRNO(name, error, what)                                           \
    EXPORTED(name) {                                                                \
        static Function function{#name, error};                                     \
        const What called_for = what;                                               \
        if (fails(function, CALLER, &called_for)) return fail_with_errno(function); \
        return real(function)(PASSED_ON);                                           \
    }

// The same where null tells of it.
#define FAILS_BY_NULL(name, error, what)                                             \
    EXPORTED(name) {                                                                 \
        static Function function{#name, error};                                      \
        const What called_for = what;                                                \
        if (!fails(function, CALLER, &called_for)) return real(function)(PASSED_ON); \
        fail_with_errno(function);                                                   \
        return 0;                                                                    \
    }

FAILS_BY_STATUS(clGetPlatformIDs)
FAILS_BY_STATUS(clGetPlatformInfo)
FAILS_BY_STATUS(clGetDeviceIDs)
FAILS_BY_STATUS(clCreateSubDevices)
FAILS_BY_STATUS(clRetainDevice)
FAILS_BY_STATUS(clReleaseDevice)
FAILS_BY_POINTER(clCreateContext, f)
FAILS_BY_STATUS(clRetainContext)
FAILS_BY_STATUS(clReleaseContext)
FAILS_BY_POINTER(clCreateCommandQueue, d)
FAILS_BY_POINTER(clCreateCommandQueueWithProperties, d)
FAILS_BY_STATUS(clReleaseCommandQueue)
FAILS_BY_POINTER(clCreateBuffer, e)
FAILS_BY_STATUS(clRetainMemObject)
FAILS_BY_STATUS(clReleaseMemObject)
FAILS_BY_POINTER(clCreateProgramWithSource, e)
FAILS_BY_STATUS(clBuildProgram)
FAILS_BY_STATUS(clGetProgramInfo)
FAILS_BY_STATUS(clGetProgramBuildInfo)
FAILS_BY_STATUS(clReleaseProgram)
FAILS_BY_POINTER(clCreateKernel, c)
FAILS_BY_STATUS(clGetKernelWorkGroupInfo)
FAILS_BY_STATUS(clReleaseKernel)
FAILS_BY_STATUS(clEnqueueNDRangeKernel)
FAILS_BY_STATUS(clEnqueueReadBuffer)
FAILS_BY_STATUS(clEnqueueWriteBuffer)
FAILS_BY_STATUS(clEnqueueFillBuffer)
FAILS_BY_POINTER(clEnqueueMapBuffer, j)
FAILS_BY_STATUS(clEnqueueUnmapMemObject)
FAILS_BY_STATUS(clGetEventProfilingInfo)
FAILS_BY_STATUS(clReleaseEvent)
FAILS_BY_STATUS(clFlush)
FAILS_BY_STATUS(clFinish)

EXPORTED(clGetDeviceInfo) {
    static Function function{"clGetDeviceInfo", -5};
    if (fails(function, CALLER)) return error_of(function);
    const char* const answer = device_answer(b);
    if (answer == nullptr) return real(function)(PASSED_ON);
    return answer_for(b, answer, c, reinterpret_cast<void*>(d), reinterpret_cast<std::size_t*>(e));
}

What argument(Word kernel, Word index) {
    static Function information{"clGetKernelInfo", 0};
    What what;
    if (!is_traced()) return what;
    constexpr Word kFunctionName = 0x1190;  // CL_KERNEL_FUNCTION_NAME
    char name[200] = {};
    real(information)(kernel, kFunctionName, sizeof name - 1, reinterpret_cast<Word>(name), 0, 0, 0,
                      0, 0, 0);
    std::snprintf(what.text, sizeof what.text, "%s %ld", name, static_cast<long>(index));
    return what;
}

// Behind the constructors of libraries, before the program's own.
EXPORTED(__libc_start_main) {
    static Function function{"__libc_start_main", 0};
    g_started = true;
    return real(function)(PASSED_ON);
}

// clSetKernelArg(kernel, index, size, value)
EXPORTED(clSetKernelArg) {
    static Function function{"clSetKernelArg", -5};
    const What what = argument(a, b);
    if (fails(function, CALLER, &what)) return error_of(function);
    return real(function)(PASSED_ON);
}

EXPORTED(open) {
    static Function function{"open", ENFILE};
    if ((b & O_TMPFILE) == O_TMPFILE && *set_to("HEMI_NAMED") != 0) {
        errno = EOPNOTSUPP;
        return -1;
    }
    const What what = path(a);
    if (fails(function, CALLER, &what)) return fail_with_errno(function);
    return real(function)(PASSED_ON);
}

FAILS_BY_ERRNO(openat, EIO, path(b))
FAILS_BY_ERRNO(read, EIO, file(a))
FAILS_BY_ERRNO(fsync, EIO, file(a))
FAILS_BY_ERRNO(rename, EIO, path(b))
FAILS_BY_ERRNO(linkat, ENOSPC, path(d))
FAILS_BY_ERRNO(unlink, EIO, path(a))
FAILS_BY_ERRNO(close, EIO, file(a))
FAILS_BY_ERRNO(flock, ENOLCK, file(a))
FAILS_BY_ERRNO(fstat, EIO, file(a))
FAILS_BY_ERRNO(stat, EIO, path(a))
FAILS_BY_ERRNO(lstat, EIO, path(a))
FAILS_BY_ERRNO(readlink, EIO, path(a))
FAILS_BY_ERRNO(access, EIO, path(a))
FAILS_BY_ERRNO(faccessat, EIO, path(b))
FAILS_BY_ERRNO(madvise, EINVAL, What{})
FAILS_BY_NULL(realpath, EIO, path(a))
FAILS_BY_NULL(fdopendir, ENOMEM, file(a))
FAILS_BY_NULL(readdir, EIO, What{})
FAILS_BY_NULL(fopen64, EMFILE, path(a))

// The file is closed nevertheless, as Linux does it.
extern "C" int fclose(FILE* stream) {
    static Function function{"fclose", EIO};
    const What what = file(fileno(stream));
    const bool failed = fails(function, CALLER, &what);
    const int status = real<int (*)(FILE*)>(function)(stream);
    return failed ? static_cast<int>(fail_with_errno(function)) : status;
}

// A disk that fills up takes the first half, and nothing of the rest.
extern "C" ssize_t write(int descriptor, const void* bytes, std::size_t count) {
    static Function function{"write", ENOSPC};
    const auto really = real<ssize_t (*)(int, const void*, std::size_t)>(function);
    const What what = file(descriptor);
    if (!fails(function, CALLER, &what)) return really(descriptor, bytes, count);
    if (g_plan.is_short && function.failed == 1) return really(descriptor, bytes, count / 2);
    return fail_with_errno(function);
}

extern "C" ssize_t writev(int descriptor, const iovec* parts, int count) {
    static Function function{"writev", ENOSPC};
    const auto really = real<ssize_t (*)(int, const iovec*, int)>(function);
    const What what = file(descriptor);
    if (!fails(function, CALLER, &what)) return really(descriptor, parts, count);
    if (g_plan.is_short && function.failed == 1) return really(descriptor, parts, 1);
    return fail_with_errno(function);
}

extern "C" void* malloc(std::size_t size) {
    static Function function{"malloc", ENOMEM};
    // Exceptions are made of it: where they cannot be, nobody can be told of anything.
    if (is_of("/libstdc++", CALLER) || !fails(function, CALLER)) return __libc_malloc(size);
    fail_with_errno(function);
    return nullptr;
}

void* operator new(std::size_t size) {
    static Function function{"new", ENOMEM};
    void* const memory = fails(function, CALLER) ? nullptr : __libc_malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
