EQU FULL, 900
EQU EMPTY, 100
level:
  in r0, 12
  cmp r0, full
  jgt stop
  cmp r0, empty
  jlt run
  ret
stop:
  mov r1, 0
  out 13, r1
  ret
run:
  mov r1, 1
  out 13, r1
  ret
