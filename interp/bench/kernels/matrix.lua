local function work(n)
   local a, b, c = {}, {}, {}
   for i = 1, n do
      a[i], b[i], c[i] = {}, {}, {}
      for j = 1, n do
         a[i][j] = i - j + 0.0
         b[i][j] = i + j + 0.0
      end
   end
   for i = 1, n do
      for j = 1, n do
         local sum = 0.0
         for k = 1, n do
            sum = sum + a[i][k] * b[k][j]
         end
         c[i][j] = sum
      end
   end
   return math.floor(c[n][1])
end

return work
