# Holds the temperature of a boiler.
EQU LIMIT, 80
EQU HEATER, 3
start:
  mov r0, 0
again:
  in r1, 7
  cmp r1, limit
  jlt heat
  out heater, r0
  jmp again
heat:
  mov r2, 1
  out heater, r2
  call wait
  jmp again
