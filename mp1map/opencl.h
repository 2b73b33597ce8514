#pragma once

// The one place that names the OpenCL headers. Debian 12's opencl.hpp compiles with 300/300 only;
// what we call exists since OpenCL 1.2.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 300
#define CL_HPP_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/opencl.hpp>
