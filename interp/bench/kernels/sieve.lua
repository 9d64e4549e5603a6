local function work(n)
   local flags, count = {}, 0
   for _ = 1, n do
      count = 0
      for i = 1, 8190 do
         flags[i] = true
      end
      for i = 1, 8190 do
         if flags[i] then
            local prime = i + i + 1
            local k = i + prime
            while k <= 8190 do
               flags[k] = false
               k = k + prime
            end
            count = count + 1
         end
      end
   end
   return count
end

return work
