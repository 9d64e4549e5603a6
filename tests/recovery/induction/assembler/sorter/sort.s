EQU COUNT, 8
sort:
  mov r0, 0
next:
  ld r1, [parts + r0]
  ld r2, [parts + r0 + 1]
  cmp r1, r2
  jlt fine
  st [parts + r0], r2
  st [parts + r0 + 1], r1
fine:
  add r0, 1
  cmp r0, count - 1
  jlt next
  ret
parts: DB 3, 1, 4, 1, 5, 9, 2, 6
