# The GPU's compiler, where it is wanted and there is one: sets FLUXEL_WITH_CUDA. Included by the project and by
# the program that checks a device alone.
set(FLUXEL_CUDA AUTO CACHE STRING "Build for GPUs: AUTO (where there is one, and nvcc), ON or OFF")
set_property(CACHE FLUXEL_CUDA PROPERTY STRINGS AUTO ON OFF)
set(FLUXEL_WITH_CUDA OFF)

# The driver's devices, natively and in Windows' subsystem for Linux.
if(FLUXEL_CUDA STREQUAL "AUTO" AND NOT EXISTS /dev/nvidiactl AND NOT EXISTS /dev/dxg)
  message(STATUS "No GPUs: this machine has none (FLUXEL_CUDA=ON builds for those of others)")
elseif(FLUXEL_CUDA)
  # Two generations of data centres' devices, and code that later ones translate.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 80-real 90-real 90-virtual)
  endif()
  if(NOT DEFINED CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
    find_program(FLUXEL_NVCC nvcc HINTS /usr/local/cuda/bin)
    mark_as_advanced(FLUXEL_NVCC)
    if(FLUXEL_NVCC)
      set(CMAKE_CUDA_COMPILER ${FLUXEL_NVCC})
    endif()
  endif()
  include(CheckLanguage)
  check_language(CUDA)
  set(why_not "CUDA's compiler is not found, or does not work with this C++ compiler: install it, or set CUDACXX to nvcc")
  if(CMAKE_CUDA_COMPILER AND "90-real" IN_LIST CMAKE_CUDA_ARCHITECTURES)
    execute_process(COMMAND ${CMAKE_CUDA_COMPILER} --list-gpu-arch OUTPUT_VARIABLE known ERROR_QUIET)
    if(NOT known MATCHES "compute_90")
      set(why_not "CUDA's compiler is older than 11.8: install a later one, or give CMAKE_CUDA_ARCHITECTURES that it knows")
      unset(CMAKE_CUDA_COMPILER CACHE)
      unset(CMAKE_CUDA_COMPILER)
    endif()
  endif()
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    set(FLUXEL_WITH_CUDA ON)
  elseif(FLUXEL_CUDA STREQUAL "ON")
    message(FATAL_ERROR "FLUXEL_CUDA=ON: ${why_not}")
  else()
    message(STATUS "No GPUs: ${why_not}")
  endif()
endif()
message(STATUS "GPUs: ${FLUXEL_WITH_CUDA} (FLUXEL_CUDA=${FLUXEL_CUDA})")

# Code for host and device: C++17, every product and sum rounded for itself, warnings as the rest of the project.
function(fluxel_portable_target target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
    $<$<COMPILE_LANGUAGE:CUDA>:-fmad=false -Xcompiler=-Wall,-Wextra,-Wconversion,-Wshadow,-ffp-contract=off
      $<$<BOOL:${FLUXEL_WERROR}>:-Werror=all-warnings -Xcompiler=-Werror>>)
  string(REPLACE ";" ", " architectures "${CMAKE_CUDA_ARCHITECTURES}")
  target_compile_definitions(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CUDA>:FLUXEL_CUDA_ARCHITECTURES="${architectures}">)
  set_target_properties(${target} PROPERTIES CUDA_STANDARD 17 CUDA_STANDARD_REQUIRED ON)
endfunction()
