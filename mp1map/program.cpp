#include "mp1map/program.h"

namespace mp1map {
namespace {

// Square roots and quotients agree with the host's to the bit where the device can round them.
std::string rounding_option(const Device& device) {
    const auto config = device.handle().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    return (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0
               ? " -cl-fp32-correctly-rounded-divide-sqrt"
               : "";
}

cl::Program built(const Device& device, const std::string& source, const std::string& options) {
    cl::Program program(device.context(), source);
    try {
        program.build(device.handle(),
                      ("-cl-std=CL1.2" + rounding_option(device) + " " + options).c_str());
    } catch (const cl::BuildError&) {
        throw DeviceError("the kernels do not compile on " + device.summary().name + ":\n" +
                          program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle()));
    }
    return program;
}

}  // namespace

std::map<std::string, Kernel> build_kernels(const Device& device,
                                            const std::vector<std::string>& names,
                                            const std::string& source, const std::string& options) {
    try {
        const cl::Program program = built(device, source, options);
        std::map<std::string, Kernel> kernels;
        for (const auto& name : names)
            kernels.emplace(name, Kernel{name, cl::Kernel(program, name.c_str())});
        return kernels;
    } catch (const cl::Error& error) {
        throw DeviceError(std::string("kernels: ") + error.what() + " failed with OpenCL error " +
                          std::to_string(error.err()));
    }
}

}  // namespace mp1map
