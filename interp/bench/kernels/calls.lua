local function twice(x)
   return x + x + 2
end

local function lesser(x, y)
   if x < y then
      return x
   end
   return y
end

-- Lua has no parameters that go out: the new value is the result.
local function count_down(x)
   return x - 1
end

local function work(n)
   local sum = 0
   for i = 1, n do
      sum = lesser(i, twice(sum))
      sum = count_down(sum)
   end
   return sum
end

return work
