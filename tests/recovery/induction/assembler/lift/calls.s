calls: DB 0, 0, 0, 0, 0, 0
press:
  in r1, 4
  st [calls + r1], r1
  add r7, 1
  jz press
  hlt
