EQU MINUTES, 60
minute:
  push r1
  ld r1, [passed]
  add r1, 1
  st [passed], r1
  cmp r1, (minutes - 1)
  jgt over
  pop r1
  ret
over:
  mov r1, 0
  st [passed], r1
  pop r1
  ret
passed: DB 0, 0
