# The program whose hashes every compiler, level, width, worker count and processor shares (./dev same-bits). Where the
# scenes are not built with their readers, it takes those files of theirs that need none, so that it crosses easily.
add_executable(same_bits test/same_bits.cpp test/same_bits_scenes.cpp)
target_include_directories(same_bits PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_options(same_bits PRIVATE ${AVBD_FP_FLAGS} ${AVBD_WARNINGS})
if(TARGET avbd_scenes)
  target_link_libraries(same_bits PRIVATE avbd_scenes)
else()
  foreach(file build trig piles stacks chain net scissor ragdolls card_house run measure penetration penetration_convex)
    target_sources(same_bits PRIVATE scenes/${file}.cpp)
  endforeach()
  target_link_libraries(same_bits PRIVATE avbd)
endif()
