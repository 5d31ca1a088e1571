#pragma once

/// Before what a device compiles too.
#ifdef __CUDACC__
#define FLUXEL_PORTABLE __host__ __device__
#else
#define FLUXEL_PORTABLE
#endif
