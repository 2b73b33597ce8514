# cmake -DBUILD=... -DWORK=... -DSCENE=... -P: see CMakeLists.txt.
function(must_run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
must_run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
must_run(${WORK}/prefix/bin/hemirad --version)
must_run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK}/consumer -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS})
must_run(${CMAKE_COMMAND} --build ${WORK}/consumer)
must_run(${WORK}/consumer/consumer ${SCENE})
