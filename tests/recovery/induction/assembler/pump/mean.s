mean:
  push r2
  ld r2, [samples]
  add r2, r0
  st [samples], r2
  sub r3, 1
  jnz more
  call level
  hlt
more:
  pop r2
  jmp mean
samples: DB 0, 0
