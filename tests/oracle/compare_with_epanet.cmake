# Installs the engine once, solves every network with it and compares: SOURCE (this folder), WORK (in the build),
# COMPARE (the comparison), NETWORKS (ours), PUBLIC_NETWORKS (may be absent).
find_program(NODE NAMES node nodejs)
find_program(NPM npm)
if(NOT NODE OR NOT NPM)
  message("SKIPPED: no nodejs or npm here, so there is no EPANET engine to compare with; tools/install-deps gets them")
  return()
endif()

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()

file(COPY ${SOURCE}/package.json ${SOURCE}/solve.mjs DESTINATION ${WORK})
if(NOT EXISTS ${WORK}/node_modules/epanet-js/package.json)
  run(${NPM} install --no-audit --no-fund --no-package-lock --loglevel=error)
endif()
file(GLOB networks ${NETWORKS}/*.inp ${PUBLIC_NETWORKS}/*.inp)
run(${NODE} solve.mjs ${WORK}/results ${networks})
run(${COMPARE} ${NETWORKS}:${PUBLIC_NETWORKS} ${WORK}/results)
