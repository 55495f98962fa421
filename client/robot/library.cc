// CMake wants a source for a library whose contents come from another one.
