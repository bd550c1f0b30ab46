# SPDX-License-Identifier: Apache-2.0
# find_package(multibot_rewrite) brings urdf_lint(): a test of ament, so that colcon test lints the package.
#
# urdf_lint([TEST_NAME name] [TIMEOUT seconds] [PATHS path ...] [OPTIONS option ...])
# lints the paths, or all of the package; options are those of the command urdf-lint.

function(urdf_lint)
  cmake_parse_arguments(LINT "" "TEST_NAME;TIMEOUT" "PATHS;OPTIONS" ${ARGN})
  if(LINT_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "urdf_lint: unknown arguments ${LINT_UNPARSED_ARGUMENTS}; "
      "use TEST_NAME, TIMEOUT, PATHS, OPTIONS")
  endif()
  if(NOT COMMAND ament_add_test)
    message(FATAL_ERROR "urdf_lint: find_package(ament_cmake REQUIRED) comes before it")
  endif()
  if(NOT LINT_TEST_NAME)
    set(LINT_TEST_NAME "urdf_lint")
  endif()
  if(NOT LINT_TIMEOUT)
    set(LINT_TIMEOUT 300)
  endif()
  if(NOT LINT_PATHS)
    set(LINT_PATHS ".")
  endif()
  # Where pip and colcon put programs, seen from share/multibot_rewrite/cmake.
  find_program(URDF_LINT_PROGRAM urdf-lint
    HINTS "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../../../bin" REQUIRED)
  set(result "${AMENT_TEST_RESULTS_DIR}/${PROJECT_NAME}/${LINT_TEST_NAME}.xunit.xml")
  ament_add_test("${LINT_TEST_NAME}"
    COMMAND "${URDF_LINT_PROGRAM}" ${LINT_PATHS} --format junit --output "${result}" ${LINT_OPTIONS}
    RESULT_FILE "${result}"
    TIMEOUT "${LINT_TIMEOUT}"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  set_tests_properties("${LINT_TEST_NAME}" PROPERTIES LABELS "linter;urdf_lint")
endfunction()
