local function work(n)
   local sqrt = math.sqrt
   local x, sum = 0.0, 0.0
   for _ = 1, n do
      x = x + 0.0009765625
      if x > 4.0 then
         x = x - 4.0
      end
      sum = sum * 0.9990234375 + sqrt(x * x + 1.0) / (x + 2.0)
   end
   return math.floor(sum + 0.5)
end

return work
