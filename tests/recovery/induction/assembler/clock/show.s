show:
  in r2, 1
  cmp r2, 0
  jz done
  out 2, r1
  jmp show
done:
  hlt
digits: DB 63, 6, 91, 79, 102
