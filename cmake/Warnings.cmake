# Flags of Fluxel's own targets; libraries are included as system headers and stay outside.
add_library(fluxel_flags INTERFACE)
target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wconversion -Wshadow>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 sees overlapping copies in every std::string + "literal" (its bug 105651).
  target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_UNITY_BUILD)
  # Sources that are compiled together are included, and GCC takes them for headers, whose types others see too.
  target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
if(NOT FLUXEL_SANITIZE)
  # No kernels for processors before 2008, which take those without vectors.
  target_compile_definitions(fluxel_flags INTERFACE HWY_DISABLED_TARGETS=HWY_SSSE3)
endif()
# A folder as one unit needs about a gigabyte; to look for garbage before that takes a sixteenth of the time.
target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1048576>)
# visibility/segment_test needs products and sums that are rounded each for itself.
target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
target_include_directories(fluxel_flags INTERFACE ${PROJECT_SOURCE_DIR})
if(FLUXEL_WERROR)
  target_compile_options(fluxel_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
if(FLUXEL_SANITIZE)
  # With clang the same build also serves its fuzzer.
  set(sanitizers address,undefined)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    set(sanitizers ${sanitizers},fuzzer-no-link)
  endif()
  add_compile_options(-fsanitize=${sanitizers} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    add_compile_options(-mssse3)  # or Highway emulates vectors by loops, whose sanitized code takes minutes to compile
  endif()
  add_link_options(-fsanitize=${sanitizers})
endif()

# Code of templates that take long to optimise, and that is not hot: options, JSON, readers of files, messages.
function(fluxel_compile_quickly target)
  target_compile_options(${target} PRIVATE -O1)
endfunction()

# A library of one folder: fluxel_layer(NAME SOURCES ... SIMD ... PUBLIC ... PRIVATE ...)
# SIMD are sources that include themselves once for each instruction set.
function(fluxel_layer name)
  cmake_parse_arguments(LAYER "" "" "SOURCES;SIMD;PUBLIC;PRIVATE" ${ARGN})
  add_library(fluxel_${name} STATIC ${LAYER_SOURCES} ${LAYER_SIMD})
  set_source_files_properties(${LAYER_SIMD} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(fluxel_${name} PUBLIC $<BUILD_INTERFACE:fluxel_flags> ${LAYER_PUBLIC} PRIVATE ${LAYER_PRIVATE})
endfunction()
