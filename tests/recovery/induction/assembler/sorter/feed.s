# Waits for a part, then sorts again.
feed:
  in r6, 5
  cmp r6, 0
  jz feed
  push r6
  call sort
  pop r6
  out 6, r6
  jmp feed
  hlt
