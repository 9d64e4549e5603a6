local function work(n)
   local sum, line = 0, ""
   for _ = 1, n do
      line = ""
      for k = 1, 40 do
         line = line .. "AB"
         sum = sum + #line - k
      end
   end
   return math.floor(sum / n) + #line
end

return work
