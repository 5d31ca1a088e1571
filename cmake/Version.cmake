# core/version.cpp learns the version and the commit at configure time.
execute_process(COMMAND git describe --always --dirty
                WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                OUTPUT_VARIABLE FLUXEL_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT FLUXEL_COMMIT)
  set(FLUXEL_COMMIT "no commit")
endif()
