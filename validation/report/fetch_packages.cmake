# cmake -DNPM=... -DFOLDER=... -P fetch_packages.cmake: npm ci, with a way out said on failure.
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
                WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "npm could not fetch the packages of report.html (its message is above). "
                      "To build without the page: cmake -DSIGNORINI_BUILD_REPORT_APP=OFF")
endif()
