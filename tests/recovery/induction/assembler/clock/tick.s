EQU SECONDS, 60
tick:
  ld r0, [now]
  add r0, 1
  cmp r0, seconds
  jlt keep
  mov r0, 0
  call minute
keep:
  st [now], r0
  ret
now: DB 0
