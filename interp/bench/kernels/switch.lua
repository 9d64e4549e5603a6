local floor = math.floor

local function work(n)
   local sum, code = 1, 1
   for _ = 1, n do
      if code == 1 then
         sum = sum + 3
         code = 4
      elseif code == 2 then
         sum = sum - 1
         code = 7
      elseif code == 3 then
         sum = sum * 2
         code = 6
      elseif code == 4 or code == 5 then
         sum = sum + code
         code = code - 2
      elseif code == 6 then
         code = 8
      elseif code == 7 then
         sum = floor(sum / 3)
         code = 5
      else
         code = 1
      end
   end
   return sum
end

return work
