local floor = math.floor

local function work(n)
   local c, sum = {}, 0
   for x = 1, 10 do
      c[x] = {}
      for y = 1, 10 do
         c[x][y] = {}
         for z = 1, 10 do
            c[x][y][z] = x * y + z
         end
      end
   end
   for _ = 1, n do
      sum = 0
      for x = 2, 9 do
         for y = 2, 9 do
            for z = 2, 9 do
               c[x][y][z] = floor((c[x - 1][y][z] + c[x + 1][y][z] + c[x][y - 1][z]
                  + c[x][y + 1][z] + c[x][y][z - 1] + c[x][y][z + 1]) / 6)
               sum = sum + c[x][y][z]
            end
         end
      end
   end
   return sum
end

return work
