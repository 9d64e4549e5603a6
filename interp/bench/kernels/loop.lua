local function work(n)
   local sum = 0
   for i = 1, n do
      sum = i - sum
   end
   return sum
end

return work
