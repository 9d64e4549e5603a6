; a part is held from the beginning to the end
t=0 IN[2]=TRUE
