#include "cli/devices.h"

#include <iostream>

#include "cli/exit_codes.h"
#include "cli/text.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

void print_pe_array(std::ostream& out, const mp1map::DeviceSummary& device) {
    const auto array = mp1map::fit_pe_array(device, {});
    out << "   PE array         --pe " << array.width << "x" << array.height << " --lanes "
        << array.lanes << " --tile " << array.tile_width << "x" << array.tile_height << ", "
        << bytes_text(array.bytes_per_pe()) << " a PE\n";
}

void print_device(std::ostream& out, const mp1map::DeviceSummary& device) {
    out << device.index << ": " << printable(device.name) << "\n"
        << "   platform         " << printable(device.platform) << ", " << printable(device.version)
        << "\n"
        << "   compute units    " << device.compute_units << "\n"
        << "   max work-group   " << device.max_work_group << "\n"
        << "   local memory     " << bytes_text(device.local_memory) << "\n"
        << "   global memory    " << bytes_text(device.global_memory) << "\n";
    if (device.lacks.empty())
        print_pe_array(out, device);
    else
        out << "   PE array         none: the device " << printable(device.lacks) << "\n";
}

int list(std::ostream& out) {
    const auto devices = mp1map::list_devices();
    if (devices.empty())
        throw mp1map::DeviceError(
            "no OpenCL device found; on Debian: apt-get install pocl-opencl-icd");
    for (const auto& device : devices) print_device(out, device);
    return kDone;
}

}  // namespace

void add_devices(CLI::App& app, Command& chosen) {
    auto& command = add_command(app, "devices", "OpenCL devices, with the PE array each would get");
    on_chosen(command, [&chosen] { chosen = [] { return list(std::cout); }; });
}

}  // namespace hemirad
