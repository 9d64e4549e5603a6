local function work(n)
   if n < 2 then
      return n
   end
   return work(n - 1) + work(n - 2)
end

return work
