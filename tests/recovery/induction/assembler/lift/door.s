open:
  push r0
  in r0, 11
  jnz blocked
  mov r0, 30
open_on:
  out 10, r0
  sub r0, 1
  jnz open_on
  pop r0
  ret
blocked:
  pop r0
  jmp open
