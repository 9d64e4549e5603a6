EQU STEPS, 4
curve: DB 10, 20, 40, 80
look:
  ld r1, [curve + r0]
  cmp r1, 40
  jgt high
  ret
high:
  hlt
