# homing_document(PROGRAM SECTION COMPONENT): after the program was linked, it writes its own man page and completion.
function(homing_document program section component)
  if(HOMING_SANITIZE)
    return()
  endif()
  set(folder ${PROJECT_BINARY_DIR}/documents)
  set(run ${CMAKE_CROSSCOMPILING_EMULATOR} $<TARGET_FILE:${program}> --documentation)
  file(MAKE_DIRECTORY ${folder}/bash ${folder}/zsh)
  add_custom_command(TARGET ${program} POST_BUILD VERBATIM
    COMMAND ${run} man > ${folder}/${program}.${section}
    COMMAND gzip -9nf ${folder}/${program}.${section}
    COMMAND ${run} bash > ${folder}/bash/${program}
    COMMAND ${run} zsh > ${folder}/zsh/_${program})
  install(FILES ${folder}/${program}.${section}.gz DESTINATION share/man/man${section} COMPONENT ${component})
  install(FILES ${folder}/bash/${program} DESTINATION share/bash-completion/completions COMPONENT ${component})
  install(FILES ${folder}/zsh/_${program} DESTINATION share/zsh/vendor-completions COMPONENT ${component})
endfunction()
