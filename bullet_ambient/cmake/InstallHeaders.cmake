# Installs the public headers of a folder, those in it itself, and below bullet_ambient/detail the headers that they need, under
# the paths of the source tree. Run by `cmake --install`, with
#   source       the root of the source tree
#   folder       bullet_ambient or preprocess
#   destination  of the public headers
#   details      folder of the others
cmake_policy(VERSION 3.25)
file(GLOB public_headers RELATIVE ${source} ${source}/${folder}/*.h)
set(needed ${public_headers})
set(unread ${public_headers})
while(unread)
  list(POP_FRONT unread header)
  file(STRINGS ${source}/${header} includes REGEX "^#include \"(bullet_ambient|preprocess)/")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${include}")
    if(NOT included IN_LIST needed)
      list(APPEND needed ${included})
      list(APPEND unread ${included})
    endif()
  endforeach()
endwhile()
foreach(header IN LISTS needed)
  if(header IN_LIST public_headers)
    file(INSTALL ${source}/${header} DESTINATION ${destination})
  elseif(NOT header MATCHES "^(bullet_ambient|preprocess)/[^/]*$")  # those are public in their own folder
    cmake_path(GET header PARENT_PATH room)
    file(INSTALL ${source}/${header} DESTINATION ${details}/${room})
  endif()
endforeach()
