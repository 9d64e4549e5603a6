EQU MOTOR, 9
EQU DOOR, 10
go:
  ld r4, [floor]
  cmp r4, r5
  jz there
  jgt down
  mov r6, 1
  out motor, r6
  jmp go
down:
  mov r6, 2
  out motor, r6
  jmp go
there:
  mov r6, 0
  out motor, r6
  call open
  ret
floor: DB 0
