#include "mp1map/program.h"

#include <sstream>

namespace mp1map {
namespace {

// Square roots and quotients agree with the host's to the bit where the device can round them.
std::string rounding_option(const Device& device) {
    const auto config = device.handle().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    return (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0
               ? " -cl-fp32-correctly-rounded-divide-sqrt"
               : "";
}

std::string build_log(const cl::Program& program, const Device& device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle());
    } catch (const cl::Error&) {
        return {};
    }
}

// Of a compiler's log, which begins with warnings.
std::string first_error(const std::string& log) {
    if (log.find_first_not_of(" \n") == std::string::npos) return "its compiler does not say why";
    const auto word = log.find("error");
    const auto at = word == std::string::npos ? log.find_first_not_of(" \n") : word;
    const auto begin = log.rfind('\n', at) + 1;  // npos + 1 is the log's begin
    return log.substr(begin, log.find('\n', at) - begin);
}

// Whether there is anything in it but that line.
bool says_more(const std::string& log, const std::string& error) {
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line != error) return true;
    return false;
}

Kernel kernel_of(const cl::Program& program, const std::string& name, const Device& device) {
    try {
        const cl::Kernel kernel(program, name.c_str());
        return {name, kernel, kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.handle())};
    } catch (const cl::Error& error) {
        throw DeviceError("kernel " + name + ": " + failure_text(error));
    }
}

cl::Program built(const Device& device, const std::string& source, const std::string& options) {
    cl::Program program(device.context(), source);
    const auto all_options = "-cl-std=CL1.2" + rounding_option(device) + " " + options;
    // cl::Program::build asks for the log where there is none, and then fails at that.
    // What LLVM throws (std::bad_alloc) passes through PoCL, which stays locked: releasing the
    // program would wait for ever. So nobody is to catch it; main's handler says what it was.
    const cl_int error = [&]() noexcept {
        return clBuildProgram(program(), 1, &device.handle()(), all_options.c_str(), nullptr,
                              nullptr);
    }();
    if (error == CL_SUCCESS) return program;
    if (error != CL_BUILD_PROGRAM_FAILURE) throw cl::Error(error, "clBuildProgram");
    const auto log = build_log(program, device);
    const auto fault = first_error(log);
    throw DeviceError("the kernels do not compile on " + device.summary().name + ": " + fault +
                      (says_more(log, fault) ? "\n" + log : ""));
}

}  // namespace

std::map<std::string, Kernel> build_kernels(const Device& device,
                                            const std::vector<std::string>& names,
                                            const std::string& source, const std::string& options) {
    try {
        const cl::Program program = built(device, source, options);
        std::map<std::string, Kernel> kernels;
        for (const auto& name : names) kernels.emplace(name, kernel_of(program, name, device));
        return kernels;
    } catch (const cl::Error& error) {
        throw DeviceError(device.summary().name + ": kernels: " + failure_text(error));
    }
}

}  // namespace mp1map
