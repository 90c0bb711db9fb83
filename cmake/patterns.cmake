# A folder's name as file(GLOB) finds it, brackets and all: a second download of an archive is named "wheel (1)" or "wheel[1]".
function(as_pattern result folder)
  string(REGEX REPLACE "([[*?])" "[\\1]" literal "${folder}")
  set(${result} "${literal}" PARENT_SCOPE)
endfunction()
