local band = bit and bit.band or load("return function(a, b) return a & b end")()
local bxor = bit and bit.bxor or load("return function(a, b) return a ~ b end")()

local function work(n)
   local state, ones = 1, 0
   for _ = 1, n do
      local half = (state - state % 2) / 2
      if band(state, 1) == 1 then
         state = bxor(half, 46080)
      else
         state = half
      end
      local rest = band(state, bxor(state, 21845))
      while rest ~= 0 do
         rest = band(rest, rest - 1)
         ones = ones + 1
      end
   end
   return ones
end

return work
