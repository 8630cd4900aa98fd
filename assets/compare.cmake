file(MAKE_DIRECTORY ${SCRATCH})
execute_process(COMMAND ${GENERATOR} ${SCRATCH} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the generator failed: ${failed}")
endif()
foreach(name sedan.obj sedan.mtl sedan_collision.obj wheel.obj wheel.mtl trip_curb.obj trip_curb.mtl car_trailer.obj car_trailer.mtl dolly.obj
        dolly.mtl drawbar_trailer.obj drawbar_trailer.mtl
        bicycle.obj bicycle.mtl bicycle_wheel.obj bicycle_wheel.mtl motorcycle.obj motorcycle.mtl
        motorcycle_wheel.obj motorcycle_wheel.mtl)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${SCRATCH}/${name} ${COMMITTED}/${name} RESULT_VARIABLE differs)
  if(differs)
    message(FATAL_ERROR "${COMMITTED}/${name} is not what the generator makes: copy ${SCRATCH}/${name} over it after looking at it")
  endif()
endforeach()
