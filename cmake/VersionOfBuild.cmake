# Run at every build: HEADER says VERSION, and the commit of SOURCE_DIR where it is a checkout of git ("-changed" where
# files differ from it). The file is touched only when that changes.
cmake_minimum_required(VERSION 3.25)
set(text "${VERSION}")
find_package(Git QUIET)
if(GIT_FOUND AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --exclude=* --dirty=-changed WORKING_DIRECTORY ${SOURCE_DIR}
                  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  if(failed EQUAL 0)
    string(APPEND text " (${commit})")
  endif()
endif()
file(CONFIGURE OUTPUT "${HEADER}"
     CONTENT "/// Made by cmake/VersionOfBuild.cmake.\n#pragma once\n#define GLIDELAB_VERSION \"\${text}\"\n")
