// Preloaded into the program, it makes calls of the C library and of OpenCL fail, and a device
// smaller than it is. faults.py is its other half. Environment:
//
//   HEMI_FAIL=NAME:N[+]      the N-th call of NAME fails, with + all later ones, too
//   HEMI_FAIL_WITH=NUMBER    errno or OpenCL's error; "short": half is written, then the disk is
//   full HEMI_FAIL_IN=all         counts the calls of device drivers and their compilers, too
//   HEMI_CALLS=FILE          gets a line "NAME calls failed" of each function at the end
//   HEMI_DEVICE=HEX=VALUE,.. answers of clGetDeviceInfo: a number, or a text
//
// OpenCL's functions and those of files take pointers and whole numbers only, a machine word each,
// so that ten words passed on are any call of theirs: so says the ABI of x86-64 and AArch64.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
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
} g_plan;
std::atomic<Function*> g_functions{nullptr};

const char* set_to(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
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
    g_plan.known = true;
}

bool is_of(const char* library, void* caller) {
    dl_find_object from;  // dladdr would look for the symbol, in LLVM for a millisecond
    return _dl_find_object(caller, &from) == 0 &&
           std::strstr(from.dlfo_link_map->l_name, library) != nullptr;
}

// What drivers and compilers call for themselves is theirs to handle.
bool is_ours(void* caller) {
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

bool fails(Function& function, void* caller) {
    read_plan();
    if (!g_plan.known || !(g_plan.all_callers || is_ours(caller))) return false;
    const long call = ++function.calls;
    if (call == 1) note(function);
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
    const int file = static_cast<int>(
        openat(AT_FDCWD, set_to("HEMI_CALLS"), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file < 0) return;
    for (const Function* one = g_functions; one != nullptr; one = one->next)
        dprintf(file, "%s %ld %ld\n", one->name, one->calls.load(), one->failed.load());
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

#define FAILS_BY_ERRNO(name, error)                                    \
    EXPORTED(name) {                                                   \
        static Function function{#name, error};                        \
        if (fails(function, CALLER)) return fail_with_errno(function); \
        return real(function)(PASSED_ON);                              \
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
FAILS_BY_STATUS(clSetKernelArg)
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

FAILS_BY_ERRNO(open, ENFILE)
FAILS_BY_ERRNO(read, EIO)
FAILS_BY_ERRNO(fsync, EIO)
FAILS_BY_ERRNO(rename, EIO)
FAILS_BY_ERRNO(linkat, ENOSPC)
FAILS_BY_ERRNO(unlink, EIO)
FAILS_BY_ERRNO(close, EIO)
FAILS_BY_ERRNO(flock, ENOLCK)
FAILS_BY_ERRNO(fstat, EIO)
FAILS_BY_ERRNO(access, EIO)
FAILS_BY_ERRNO(faccessat, EIO)
FAILS_BY_ERRNO(madvise, EINVAL)

extern "C" FILE* fopen64(const char* path, const char* mode) {
    static Function function{"fopen64", EMFILE};
    if (!fails(function, CALLER))
        return real<FILE* (*)(const char*, const char*)>(function)(path, mode);
    fail_with_errno(function);
    return nullptr;
}

// The file is closed nevertheless, as Linux does it.
extern "C" int fclose(FILE* file) {
    static Function function{"fclose", EIO};
    const bool failed = fails(function, CALLER);
    const int status = real<int (*)(FILE*)>(function)(file);
    return failed ? static_cast<int>(fail_with_errno(function)) : status;
}

// A disk that fills up takes the first half, and nothing of the rest.
extern "C" ssize_t write(int file, const void* bytes, std::size_t count) {
    static Function function{"write", ENOSPC};
    const auto really = real<ssize_t (*)(int, const void*, std::size_t)>(function);
    if (!fails(function, CALLER)) return really(file, bytes, count);
    if (g_plan.is_short && function.failed == 1) return really(file, bytes, count / 2);
    return fail_with_errno(function);
}

extern "C" ssize_t writev(int file, const iovec* parts, int count) {
    static Function function{"writev", ENOSPC};
    const auto really = real<ssize_t (*)(int, const iovec*, int)>(function);
    if (!fails(function, CALLER)) return really(file, parts, count);
    if (g_plan.is_short && function.failed == 1) return really(file, parts, 1);
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
