wait:
  push r3
  mov r3, 200
wait_on:
  sub r3, 1
  jnz wait_on
  pop r3
  ret
